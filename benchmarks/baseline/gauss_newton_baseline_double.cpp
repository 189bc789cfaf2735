// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/baseline/gauss_newton_solver.h"

namespace marey::gauss_newton {

template std::unique_ptr<GaussNewtonBaseline> make_dual<double>(
    const Skeleton&, const std::vector<PointMass>&, std::span<const PointGoal>, bool);

}  // namespace marey::gauss_newton

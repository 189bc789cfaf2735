// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: priors of a person and of tags: lengths near an average
// person's and equal on both sides, tags on the soft tissue around the bone and facing
// away from it.

#include <Eigen/Core>

#include "reconstruct/bundle/subject_equations.h"

namespace marey::reconstruct {

/// Gauss-Newton's equations over the subject's unknowns (SubjectColumns). Only the lower
/// triangle of the Hessian is filled.
struct SubjectSystem {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  double cost = 0.0;
};

/// Adds the terms of a body, given an average person's lengths `usual`. Limb tags: at
/// least 2 cm off the bone's axis on the side that they face, at most 9 cm (forearms) to
/// 14 cm (thighs), between the bone's ends; tags elsewhere within 0.2 to 0.4 m of their
/// joint, a hand's within 7 cm of its line. Terms are zero inside and quadratic outside,
/// except two Gaussians on limb tags: the facing term (2 cm) and the distance from the
/// axis (upper arm 5.8 +- 2.2 cm, forearm 4.5 +- 1.8, thigh 9.0 +- 2.8, shank 6.2 +-
/// 2.2).
void add_subject_priors(const BodyModel& model,
                        const Lengths& usual,
                        const SubjectColumns& columns,
                        SubjectSystem& out);

/// Returns the distance of the tag from the soft tissue of its segment, in the prior's
/// sigmas and without the Gaussian terms; 0 on it.
[[nodiscard]] double off_soft_tissue(const BodyModel& model, std::size_t tag);

}  // namespace marey::reconstruct

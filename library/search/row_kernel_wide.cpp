// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/row_kernel.h"

#if defined(__AVX2__)
#include "library/search/row_loop.h"
#endif

namespace marey::library {

SquaredDistances make_wide_row_kernel() {
#if defined(__AVX2__)
  return &RowLoop<xsimd::batch<float, xsimd::avx2>>::run;
#else
  return nullptr;
#endif
}

}  // namespace marey::library

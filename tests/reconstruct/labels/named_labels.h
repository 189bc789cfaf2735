// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "reconstruct/labels/name_markers.h"

namespace marey::reconstruct::testing {

/// Returns the words of a text, separated by blanks.
[[nodiscard]] std::vector<std::string> words(const std::string& text);

/// Returns the name of `label`, "" for none.
[[nodiscard]] std::string name_of(const std::vector<std::string>& labels,
                                  const MarkerNames& names,
                                  const std::string& label);

/// Returns the labels that name_markers() does not name.
[[nodiscard]] std::vector<std::string> unnamed(const std::vector<std::string>& labels);

struct LabelAndName {
  const char* label;
  const char* name;
};

/// Expects that name_markers() finds this set, and these names.
void expect_names(const std::vector<std::string>& labels,
                  const std::string& set,
                  std::initializer_list<LabelAndName> pairs);

/// Plug-in Gait's markers of the whole body.
inline constexpr const char* kPlugInGait =
    "LFHD RFHD LBHD RBHD C7 T10 CLAV STRN RBAK LSHO LUPA LELB LFRM LWRA LWRB LFIN RSHO "
    "RUPA RELB RFRM RWRA RWRB RFIN LASI RASI LPSI RPSI LTHI LKNE LTIB LANK LHEE LTOE "
    "RTHI RKNE RTIB RANK RHEE RTOE";

}  // namespace marey::reconstruct::testing

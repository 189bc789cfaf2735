// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "core/humanoid.h"
#include "live/page/page_wizard.h"
#include "reconstruct/subject/fit_subject.h"

namespace marey::app {

/// Returns the name of a bone in words, for example "left lower arm".
[[nodiscard]] std::string in_words(HumanBone bone);

/// Returns the quality of a measured subject as text for users: the length of each limb
/// with its standard deviation (poor above 1 cm, or if it differs by 5 % from the other
/// side), the residual to the detections (poor above 5 px), the limb lengths relative to
/// an average person (poor beyond 15 %), and the tags without a position (poor above a
/// fifth).
[[nodiscard]] std::vector<Finding> assess_live_subject(
    const reconstruct::SubjectFit& fit);

}  // namespace marey::app

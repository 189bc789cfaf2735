// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/humanoid.h"
#include "live/page/page_wizard.h"
#include "reconstruct/subject/fit_subject.h"

namespace marey::app {

/// "left lower arm".
[[nodiscard]] std::string in_words(HumanBone bone);

/// How good a measured person is, for people to read: the limbs' lengths, each with its
/// standard deviation (poor above 1 cm, or 5 % from the other side's), how far the body is
/// from what cameras saw (poor above 5 px), limbs against an average person's (poor beyond
/// 15 %), and tags without a place (poor when more than a fifth).
[[nodiscard]] std::vector<live::WizardQuality> quality_of(
    const reconstruct::SubjectFit& fit);

}  // namespace marey::app

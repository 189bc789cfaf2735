// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "live/page/page_json.h"

namespace marey::live {

struct PageWizard;

/// Returns the message `wizard`, which is also a member of the scene.
[[nodiscard]] PageJson wizard_object(const PageWizard& wizard);

}  // namespace marey::live

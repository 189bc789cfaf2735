// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace marey::recordings {

/// Appends `value` with `decimals` digits after the point, in any locale. A value that
/// rounds to zero has no sign. Precondition: finite, 0 <= decimals <= 20.
void append_fixed(std::string& text, double value, int decimals = 6);

/// Appends the shortest digits that read back as `value` exactly, in any locale.
void append_exact(std::string& text, double value);
void append_exact(std::string& text, int value);

}  // namespace marey::recordings

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace marey::recordings {

/// Appends `value` with `decimals` digits after the point, whatever the locale; what
/// rounds to nothing is written without a sign. Precondition: finite, 0 <= decimals
/// <= 20.
void append_fixed(std::string& text, double value, int decimals = 6);

/// Appends the shortest digits from which reading gives `value` again, bit for bit,
/// whatever the locale.
void append_exact(std::string& text, double value);
void append_exact(std::string& text, int value);

}  // namespace marey::recordings

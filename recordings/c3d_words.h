// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "recordings/c3d.h"

namespace marey::recordings {

/// The 16-bit integer at `bytes`. Precondition: 2 bytes are there.
[[nodiscard]] std::uint16_t c3d_word(C3dProcessor processor, const char* bytes);

/// The real at `bytes`. Reserved operands of a VAX are 0. Precondition: 4 bytes are
/// there.
[[nodiscard]] float c3d_real(C3dProcessor processor, const char* bytes);

void append_c3d_word(std::string& out, C3dProcessor processor, std::uint16_t value);
/// What a VAX has no real for is its largest, or 0.
void append_c3d_real(std::string& out, C3dProcessor processor, float value);

}  // namespace marey::recordings

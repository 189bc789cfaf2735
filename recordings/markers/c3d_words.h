// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "recordings/markers/c3d.h"

namespace marey::recordings {

/// Returns the 16-bit integer at `bytes`. Precondition: 2 bytes are readable.
[[nodiscard]] std::uint16_t c3d_word(C3dProcessor processor, const char* bytes);

/// Returns the real at `bytes`. Reserved operands of a VAX become 0. Precondition: 4
/// bytes are readable.
[[nodiscard]] float c3d_real(C3dProcessor processor, const char* bytes);

void append_c3d_word(std::string& out, C3dProcessor processor, std::uint16_t value);
/// Appends a real. Values outside the VAX range become the largest VAX real, or 0.
void append_c3d_real(std::string& out, C3dProcessor processor, float value);

}  // namespace marey::recordings

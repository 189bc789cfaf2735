// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace marey::live {

/// One page that is connected; never used again for another.
enum class ClientId : std::uint64_t {};

/// What a page said.
struct ReceivedText {
  ClientId client{};
  std::string text;
};

}  // namespace marey::live

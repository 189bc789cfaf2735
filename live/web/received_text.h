// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace marey::live {

/// Identifier of a connected page; never reused.
enum class ClientId : std::uint64_t {};

/// A text received from a page.
struct ReceivedText {
  ClientId client{};
  std::string text;
};

}  // namespace marey::live

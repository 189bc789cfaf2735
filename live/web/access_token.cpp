// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/access_token.h"

#include <array>
#include <cerrno>
#include <cstddef>

#include <sys/random.h>

namespace marey::live {

Result<std::string> make_access_token() {
  std::array<unsigned char, 16> bits{};
  std::size_t filled = 0;
  while (filled < bits.size()) {
    const ssize_t got = getrandom(bits.data() + filled, bits.size() - filled, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      return Error{Errc::kInternal,
                   "access token",
                   "the system returns no random numbers",
                   "serve this machine only, without --lan"};
    }
    filled += static_cast<std::size_t>(got);
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bits) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

bool same_token(std::string_view given, std::string_view token) {
  if (given.size() != token.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i) {
    difference |= static_cast<unsigned>(static_cast<unsigned char>(given[i]) ^
                                        static_cast<unsigned char>(token[i]));
  }
  // Volatile, so that the compiler cannot end the loop early.
  const volatile unsigned result = difference;
  return result == 0;
}

}  // namespace marey::live

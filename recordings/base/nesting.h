// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace marey::recordings {

/// Maximum nesting of JSON and TOML. Parsers, destructors and copies of their trees are
/// recursive: a file of some kilobytes could exhaust the stack.
inline constexpr std::size_t kMaxNesting = 100;

/// Returns true if brackets of the JSON text nest deeper than kMaxNesting. Correct for
/// every prefix that is valid JSON, so that a parser may run after it. Linear; allocates
/// nothing.
[[nodiscard]] bool json_nests_too_deep(std::string_view json);

/// Maximum keys of one JSON object. Objects that keep the order of the file compare each
/// key with those before it.
inline constexpr std::size_t kMaxKeys = 10'000;

/// Returns true if an object of the JSON text has more than kMaxKeys keys. Correct for
/// every prefix that is valid JSON. Linear. Precondition: json_nests_too_deep() is false.
[[nodiscard]] bool json_has_too_many_keys(std::string_view json);

/// Returns true if tables and arrays of the TOML text nest deeper than kMaxNesting:
/// brackets, dotted keys and headers together. Correct for every prefix that is valid
/// TOML. Linear.
[[nodiscard]] bool toml_nests_too_deep(std::string_view toml);

}  // namespace marey::recordings

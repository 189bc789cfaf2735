// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/edit/moment.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings::recipe {

// Values that several operations have in common: how recipes hold them. Readers store
// mistakes in the document (TomlReader).

/// Reads a text of one line that is not empty. Mistakes: empty; a control character; more
/// than `max_bytes`.
[[nodiscard]] std::string read_line(TomlReader& in,
                                    std::string_view key,
                                    std::size_t max_bytes);

/// Reads an array of `count` numbers, each within the limits.
[[nodiscard]] std::vector<double> read_numbers(TomlReader& in,
                                               std::string_view key,
                                               std::size_t count,
                                               const Limits& limits);

/// Checks that each number is within the limits.
void check_numbers(TomlReader& in,
                   std::string_view key,
                   std::span<const double> values,
                   const Limits& limits);
/// Stores the mistake that two keys of the same meaning are given.
void fail_twice(TomlReader& in, std::string_view first, std::string_view second);

/// Returns the keys that can hold an instant: "at_s", "at_frame" and "at" for "at".
[[nodiscard]] std::vector<std::string> moment_keys(std::string_view key);
/// Reads an instant from one of its keys; nullopt if none is there.
/// Mistakes: two of them; an annotation without a name.
[[nodiscard]] std::optional<Moment> read_moment(TomlReader& in, std::string_view key);
/// Reads an instant that must be there.
[[nodiscard]] Moment read_needed_moment(TomlReader& in, std::string_view key);
void write_moment(TomlWriter& out, std::string_view key, const Moment& moment);
/// Returns whether `a` is certainly later than `b`: both are times, or both frames.
[[nodiscard]] bool is_later(const Moment& a, const Moment& b);
/// Checks that a span does not end before it starts. Mistake at `key`.
void check_span(TomlReader& in, std::string_view key, const EditSpan& span);

}  // namespace marey::recordings::recipe

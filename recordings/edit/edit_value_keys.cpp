// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_value_keys.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <variant>

#include "core/base/in_quotes.h"
#include "recordings/base/number_text.h"
#include "recordings/edit/edit_limits.h"

namespace marey::recordings::recipe {
namespace {

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7F;
}

/// Returns KEY_WORD.
std::string with_key_ending(std::string_view key, std::string_view ending) {
  return std::string(key).append(ending);
}

/// Reads "left.strike[2]".
AtAnnotation read_annotation(TomlReader& in, std::string_view key) {
  AtAnnotation at{in.text(key), 0};
  const std::size_t open = at.text.rfind('[');
  if (open != std::string::npos && at.text.back() == ']' && open + 2 < at.text.size()) {
    const char* const first = at.text.data() + open + 1;
    const char* const last = at.text.data() + at.text.size() - 1;
    const bool is_digits =
        std::all_of(first, last, [](char c) { return c >= '0' && c <= '9'; });
    int number = 0;
    const auto [end, problem] = std::from_chars(first, last, number);
    if (is_digits && (problem != std::errc{} || number > kMaxOccurrence)) {
      in.fail(key,
              in_quotes(key) + " has a number above 1000000 in brackets",
              "give the number of the occurrence, counted from 0");
    }
    if (is_digits) {
      at.occurrence = number;
      at.text.resize(open);
    }
  }
  const bool is_line = std::none_of(at.text.begin(), at.text.end(), is_control);
  if (at.text.empty() || !is_line || at.text.size() > kMaxNameBytes) {
    in.fail(key,
            in_quotes(key) + " does not name an annotation",
            "give a name, as in \"left.strike[2]\": the third strike");
  }
  return at;
}

bool ends_with_number(const std::string& text) {
  const std::size_t open = text.rfind('[');
  return open != std::string::npos && text.back() == ']' && open + 2 < text.size() &&
         text.find_first_not_of("0123456789", open + 1) == text.size() - 1;
}

void write_frame(TomlWriter& out, std::string_view key, double frame) {
  const bool is_whole = frame == std::floor(frame) && std::abs(frame) <= kFrame.high;
  if (is_whole) {
    out.integer(key, static_cast<int>(frame));
  } else {
    out.number(key, frame);
  }
}

}  // namespace

std::string read_line(TomlReader& in, std::string_view key, std::size_t max_bytes) {
  std::string text = in.text(key);
  if (!in.ok()) return text;
  if (text.empty()) in.fail(key, in_quotes(key) + " is empty", "write its text");
  if (std::any_of(text.begin(), text.end(), is_control)) {
    in.fail(key,
            in_quotes(key) + " contains a line end or a control character",
            "write one line of text");
  }
  if (text.size() > max_bytes) {
    std::string cause = in_quotes(key) + " is longer than ";
    append_exact(cause, static_cast<int>(max_bytes));
    in.fail(key, cause + " bytes", "write a shorter text");
  }
  return text;
}

void check_numbers(TomlReader& in,
                   std::string_view key,
                   std::span<const double> values,
                   const Limits& limits) {
  for (const double value : values) {
    if (value >= limits.low && value <= limits.high) continue;
    std::string cause = in_quotes(key) + " contains ";
    append_exact(cause, value);
    cause += ", not between ";
    append_exact(cause, limits.low);
    cause += " and ";
    append_exact(cause, limits.high);
    cause.append(" ").append(limits.unit);
    in.fail(key, std::move(cause), std::string("give it in ").append(limits.unit));
  }
}

void fail_twice(TomlReader& in, std::string_view first, std::string_view second) {
  in.fail(second,
          "both " + in_quotes(first) + " and " + in_quotes(second) + " are given",
          "remove one: they have the same meaning");
}

std::vector<double> read_numbers(TomlReader& in,
                                 std::string_view key,
                                 std::size_t count,
                                 const Limits& limits) {
  std::vector<double> values = in.numbers(key, count);
  check_numbers(in, key, values, limits);
  return values;
}

std::vector<std::string> moment_keys(std::string_view key) {
  return {with_key_ending(key, "_s"), with_key_ending(key, "_frame"), std::string(key)};
}

std::optional<Moment> read_moment(TomlReader& in, std::string_view key) {
  const std::vector<std::string> keys = moment_keys(key);
  const std::string* found = nullptr;
  for (const std::string& one : keys) {
    if (!in.has(one)) continue;
    if (found) fail_twice(in, *found, one);
    found = &one;
  }
  if (!found) return std::nullopt;
  if (found == &keys[0]) return AtTime{in.number(*found, kTime)};
  if (found == &keys[1]) return AtFrame{in.number(*found, kFrame)};
  if (!in.is_text(key)) {
    in.fail(key,
            in_quotes(key) + " must be the name of an annotation in quotes",
            "write " + keys[0] + " for seconds, or " + keys[1] + " for a frame");
  }
  return read_annotation(in, key);
}

Moment read_needed_moment(TomlReader& in, std::string_view key) {
  const std::optional<Moment> moment = read_moment(in, key);
  if (moment) return *moment;
  const std::vector<std::string> keys = moment_keys(key);
  in.fail("",
          "the key " + in_quotes(keys[0]) + " is missing",
          "add " + keys[0] + " (seconds), " + keys[1] + " or " + keys[2] +
              " (an annotation)");
  return AtFrame{};
}

void write_moment(TomlWriter& out, std::string_view key, const Moment& moment) {
  if (const auto* time = std::get_if<AtTime>(&moment)) {
    out.number(with_key_ending(key, "_s"), time->time_s);
  } else if (const auto* frame = std::get_if<AtFrame>(&moment)) {
    write_frame(out, with_key_ending(key, "_frame"), frame->frame);
  } else if (const auto* at = std::get_if<AtAnnotation>(&moment)) {
    std::string text = at->text;
    if (at->occurrence != 0 || ends_with_number(text)) {
      text += '[';
      append_exact(text, at->occurrence);
      text += ']';
    }
    out.text(key, text);
  }
}

bool is_later(const Moment& a, const Moment& b) {
  const auto* const time_a = std::get_if<AtTime>(&a);
  const auto* const time_b = std::get_if<AtTime>(&b);
  if (time_a && time_b) return time_a->time_s > time_b->time_s;
  const auto* const frame_a = std::get_if<AtFrame>(&a);
  const auto* const frame_b = std::get_if<AtFrame>(&b);
  return frame_a && frame_b && frame_a->frame > frame_b->frame;
}

void check_span(TomlReader& in, std::string_view key, const EditSpan& span) {
  if (!span.from || !span.to || !is_later(*span.from, *span.to)) return;
  in.fail(key, "the span ends before it starts", "exchange its two ends");
}

}  // namespace marey::recordings::recipe

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "core/base/assert.h"

namespace marey {

/// Kind of an error, by the party able to fix it; determines the program's exit code
/// (docs/formats/exit_codes.md).
enum class Errc {
  kInternal,  ///< A bug in marey.
  kUsage,     ///< The command line.
  kBadInput,  ///< A file or setting of the user.
  kQuality,   ///< Done, but the quality is too low.
  kDevice,    ///< A camera, disk or network.
};

/// An error that a user can act on. All three parts are plain sentences or names without
/// a trailing full stop.
struct Error {
  Errc code = Errc::kInternal;
  std::string where;  ///< File, and line or frame: "walk/cam2.mp4: frame 63".
  std::string cause;  ///< "the video ends after 63 of 127 frames".
  std::string next;   ///< "copy the file from the camera again".
  int os_error = 0;   ///< errno of the operation that failed; 0: none, or not known.

  /// One line: "where: cause. Next: next."
  [[nodiscard]] std::string message() const {
    std::string text = where.empty() ? cause : where + ": " + cause;
    if (!next.empty()) text += ". Next: " + next;
    return text + ".";
  }
};

[[nodiscard]] inline Error bad_input(std::string where,
                                     std::string cause,
                                     std::string next) {
  return {Errc::kBadInput, std::move(where), std::move(cause), std::move(next)};
}

[[nodiscard]] inline Error bad_usage(std::string where,
                                     std::string cause,
                                     std::string next) {
  return {Errc::kUsage, std::move(where), std::move(cause), std::move(next)};
}

/// A value or an Error. Has a subset of std::expected's interface, so that it can become
/// an alias of it when the toolchain supports it.
template <class T>
class [[nodiscard]] Result {
 public:
  // Implicit on purpose, so that a function can simply `return value;`.
  // NOLINTNEXTLINE(google-explicit-constructor)
  Result(T value) : state_(std::move(value)) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}

  [[nodiscard]] bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// Precondition: has_value().
  [[nodiscard]] const T& operator*() const& {
    MAREY_ASSERT(has_value());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T& operator*() & {
    MAREY_ASSERT(has_value());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T&& operator*() && {
    MAREY_ASSERT(has_value());
    return std::move(*std::get_if<0>(&state_));
  }
  [[nodiscard]] const T* operator->() const { return &**this; }
  [[nodiscard]] T* operator->() { return &**this; }

  /// Precondition: !has_value().
  [[nodiscard]] const Error& error() const {
    MAREY_ASSERT(!has_value());
    return *std::get_if<1>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value: `return Done{};`.
struct Done {};
using Status = Result<Done>;

}  // namespace marey

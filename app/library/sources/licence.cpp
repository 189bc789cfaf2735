// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/licence.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/base/lower_case.h"
#include "core/nearest_word.h"

namespace marey::app {
namespace {

/// Licences of data, and those of programs that data sets use.
constexpr std::array<std::string_view, 61> kLicences = {"0BSD",
                                                        "AFL-3.0",
                                                        "AGPL-3.0-only",
                                                        "AGPL-3.0-or-later",
                                                        "Apache-2.0",
                                                        "Artistic-2.0",
                                                        "BSD-1-Clause",
                                                        "BSD-2-Clause",
                                                        "BSD-3-Clause",
                                                        "BSL-1.0",
                                                        "CC-BY-1.0",
                                                        "CC-BY-2.0",
                                                        "CC-BY-2.5",
                                                        "CC-BY-3.0",
                                                        "CC-BY-4.0",
                                                        "CC-BY-NC-1.0",
                                                        "CC-BY-NC-2.0",
                                                        "CC-BY-NC-2.5",
                                                        "CC-BY-NC-3.0",
                                                        "CC-BY-NC-4.0",
                                                        "CC-BY-NC-ND-1.0",
                                                        "CC-BY-NC-ND-2.0",
                                                        "CC-BY-NC-ND-2.5",
                                                        "CC-BY-NC-ND-3.0",
                                                        "CC-BY-NC-ND-4.0",
                                                        "CC-BY-NC-SA-1.0",
                                                        "CC-BY-NC-SA-2.0",
                                                        "CC-BY-NC-SA-2.5",
                                                        "CC-BY-NC-SA-3.0",
                                                        "CC-BY-NC-SA-4.0",
                                                        "CC-BY-ND-1.0",
                                                        "CC-BY-ND-2.0",
                                                        "CC-BY-ND-2.5",
                                                        "CC-BY-ND-3.0",
                                                        "CC-BY-ND-4.0",
                                                        "CC-BY-SA-1.0",
                                                        "CC-BY-SA-2.0",
                                                        "CC-BY-SA-2.5",
                                                        "CC-BY-SA-3.0",
                                                        "CC-BY-SA-4.0",
                                                        "CC-PDDC",
                                                        "CC0-1.0",
                                                        "CDLA-Permissive-1.0",
                                                        "CDLA-Permissive-2.0",
                                                        "CDLA-Sharing-1.0",
                                                        "EPL-2.0",
                                                        "EUPL-1.2",
                                                        "GPL-2.0-only",
                                                        "GPL-2.0-or-later",
                                                        "GPL-3.0-only",
                                                        "GPL-3.0-or-later",
                                                        "ISC",
                                                        "LGPL-2.1-or-later",
                                                        "LGPL-3.0-or-later",
                                                        "MIT",
                                                        "MPL-2.0",
                                                        "ODC-By-1.0",
                                                        "ODbL-1.0",
                                                        "PDDL-1.0",
                                                        "Unlicense",
                                                        "Zlib"};

constexpr std::array<std::string_view, 5> kExceptions = {"Autoconf-exception-3.0",
                                                         "Classpath-exception-2.0",
                                                         "Font-exception-2.0",
                                                         "GCC-exception-3.1",
                                                         "LLVM-exception"};

constexpr std::string_view kOwnPrefix = "LicenseRef-";

std::optional<std::string_view> known_word(std::string_view word,
                                           std::span<const std::string_view> list) {
  const auto found = std::ranges::find_if(
      list, [&](std::string_view one) { return lower_case(one) == lower_case(word); });
  if (found == list.end()) return std::nullopt;
  return *found;
}

/// Returns true for "LicenseRef-NAME" with letters, digits, '-' and '.'.
bool is_own_licence(std::string_view word) {
  if (!word.starts_with(kOwnPrefix) || word.size() == kOwnPrefix.size()) return false;
  return std::ranges::all_of(word, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           c == '-' || c == '.';
  });
}

/// Reads an expression by recursive descent: OR of AND of WITH.
class LicenceReader {
 public:
  explicit LicenceReader(std::string_view text) : text_(text) {
    std::string word;
    const auto end_word = [&] {
      if (!word.empty()) words_.push_back(std::exchange(word, {}));
    };
    for (const char c : text) {
      if (c == ' ' || c == '\t' || c == '(' || c == ')') end_word();
      if (c == '(' || c == ')') words_.emplace_back(1, c);
      if (c != ' ' && c != '\t' && c != '(' && c != ')') word += c;
    }
    end_word();
  }

  Result<std::string> read() {
    constexpr std::size_t kMaxWords = 200;
    if (words_.empty() || words_.size() > kMaxWords) {
      return fail("the licence is empty or too long");
    }
    if (const Status ok = read_choice(); !ok) return ok.error();
    if (at_ < words_.size()) {
      return fail(in_quotes(words_[at_]) + " is out of place in the licence " +
                  in_quotes(text_));
    }
    return std::move(out_);
  }

 private:
  static Error fail(std::string cause) {
    return bad_input("--licence",
                     std::move(cause),
                     "give an SPDX expression such as CC-BY-4.0 or MIT OR Apache-2.0, "
                     "LicenseRef-NAME for a licence of its own, or a file with its text");
  }

  [[nodiscard]] bool is_next(std::string_view word) const {
    return at_ < words_.size() && words_[at_] == word;
  }

  Status read_choice() {
    if (const Status ok = read_both(); !ok) return ok;
    while (is_next("OR")) {
      ++at_;
      out_ += " OR ";
      if (const Status ok = read_both(); !ok) return ok;
    }
    return Done{};
  }

  Status read_both() {
    if (const Status ok = read_term(); !ok) return ok;
    while (is_next("AND")) {
      ++at_;
      out_ += " AND ";
      if (const Status ok = read_term(); !ok) return ok;
    }
    return Done{};
  }

  Status read_term() {
    if (at_ >= words_.size()) {
      return fail("the licence " + in_quotes(text_) + " is not complete");
    }
    if (is_next("(")) return read_group();
    const std::string word = words_[at_++];
    if (is_own_licence(word)) {
      out_ += word;
      return Done{};
    }
    const bool is_or_later = word.ends_with('+');
    const auto known = known_word(is_or_later ? word.substr(0, word.size() - 1) : word,
                                  std::span<const std::string_view>(kLicences));
    if (!known) {
      Error error = fail("the licence " + in_quotes(word) + " is not known");
      error.next = suggestion(word, kLicences) + "; or " + error.next;
      return error;
    }
    out_ += std::string(*known) + (is_or_later ? "+" : "");
    if (!is_next("WITH")) return Done{};
    ++at_;
    const std::string exception = at_ < words_.size() ? words_[at_++] : "";
    const auto found =
        known_word(exception, std::span<const std::string_view>(kExceptions));
    if (!found) {
      return fail(in_quotes(exception) + " is not an exception that SPDX knows");
    }
    out_ += " WITH " + std::string(*found);
    return Done{};
  }

  Status read_group() {
    ++at_;
    out_ += "(";
    if (const Status ok = read_choice(); !ok) return ok;
    if (!is_next(")")) {
      return fail("a parenthesis is not closed in the licence " + in_quotes(text_));
    }
    ++at_;
    out_ += ")";
    return Done{};
  }

  std::string_view text_;
  std::vector<std::string> words_;
  std::size_t at_ = 0;
  std::string out_;
};

}  // namespace

std::span<const std::string_view> known_licences() {
  return kLicences;
}

Result<std::string> spdx_licence(std::string_view text) {
  if (text == "unknown") return std::string(text);
  return LicenceReader(text).read();
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/option_checks.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

#include "app/shell/word_list.h"
#include "core/base/assert.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

/// Returns a number as a user writes it: 1000000, 0.001.
std::string plain_number(double number) {
  return format_text("%.10g", number);
}

std::optional<double> as_number(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0') return std::nullopt;
  return number;
}

/// Accepts the words that CLI11 converts: decimal, 0x and octal numbers.
std::optional<long long> as_whole_number(const std::string& word) {
  char* end = nullptr;
  errno = 0;
  const long long number = std::strtoll(word.c_str(), &end, 0);
  if (word.empty() || *end != '\0' || errno != 0) return std::nullopt;
  return number;
}

/// Returns "must be WANTED, not WORD".
std::string not_that(const std::string& wanted, const std::string& word) {
  const bool is_number = as_number(word).has_value();
  return "must be " + wanted + ", not " + (is_number ? word : in_quotes(word));
}

/// Returns the cause for a word that is no usable number; empty if it is one.
std::string number_problem(const std::string& word) {
  const auto number = as_number(word);
  if (!number || std::isnan(*number)) return not_that("a number", word);
  if (std::abs(*number) <= kMaxNumber) return {};
  return not_that("a number of at most " + plain_number(kMaxNumber), word);
}

std::string whole_number_problem(const std::string& word) {
  if (!as_whole_number(word)) return not_that("a whole number", word);
  return number_problem(word);
}

bool has_type(const CLI::Option& option, std::string_view type) {
  return option.get_type_name().find(type) != std::string::npos;
}

std::string from_to(double low, double high) {
  return "from " + plain_number(low) + " to " + plain_number(high);
}

}  // namespace

CLI::Validator between(double low, double high) {
  const std::string range = from_to(low, high);
  const auto check = [=](const std::string& word) {
    const auto number = as_number(word);
    const bool is_inside = number && *number >= low && *number <= high;
    return is_inside ? std::string() : not_that("a number " + range, word);
  };
  return {check, range};
}

CLI::Validator whole_between(long low, long high) {
  const std::string range = from_to(static_cast<double>(low), static_cast<double>(high));
  const auto check = [=](const std::string& word) {
    const auto number = as_whole_number(word);
    const bool is_inside = number && *number >= low && *number <= high;
    return is_inside ? std::string() : not_that("a whole number " + range, word);
  };
  return {check, range};
}

CLI::Validator zero_or_between(long low, long high) {
  const std::string range = from_to(static_cast<double>(low), static_cast<double>(high));
  const auto check = [=](const std::string& word) {
    const auto number = as_whole_number(word);
    const bool is_inside =
        number && (*number == 0 || (*number >= low && *number <= high));
    return is_inside ? std::string() : not_that("0 or a whole number " + range, word);
  };
  return {check, "0, or " + range};
}

CLI::Validator one_of(std::vector<std::string> words) {
  MAREY_ASSERT(!words.empty());
  const std::string list = or_list(words);
  const auto check = [words = std::move(words), list](const std::string& word) {
    const bool is_one = std::ranges::find(words, word) != words.end();
    return is_one ? std::string() : not_that(list, word);
  };
  return {check, list};
}

std::string PlainHelp::make_option_opts(const CLI::Option* option) const {
  std::string text = CLI::Formatter::make_option_opts(option);
  const std::string type = option->get_type_name();
  const std::size_t colon = type.find(':');
  const std::size_t begin = text.find(type);
  if (colon == std::string::npos || begin == std::string::npos) return text;
  return text.insert(begin + colon + 1, " ");
}

void refuse_absurd_numbers(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (has_type(*option, "FLOAT")) {
      option->check(CLI::Validator(number_problem, ""));
    } else if (has_type(*option, "INT")) {
      option->check(CLI::Validator(whole_number_problem, ""));
    }
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    refuse_absurd_numbers(*command);
  }
}

Status check_out_folder(const std::filesystem::path& out) {
  namespace fs = std::filesystem;
  std::error_code problem;
  fs::path at = fs::absolute(out, problem).lexically_normal();
  // Finds the nearest existing path. A symlink counts as existing even if its target is
  // missing.
  while (!fs::exists(fs::symlink_status(at, problem)) && at.has_relative_path()) {
    at = at.parent_path();
  }
  if (fs::is_directory(at, problem)) return Done{};
  return bad_input(out.string(),
                   "results cannot be written here: " + at.string() + " is not a folder",
                   "choose another folder with --out");
}

Status check_out_file(const std::filesystem::path& out) {
  std::error_code absent;
  if (!std::filesystem::is_directory(out, absent)) return Done{};
  return bad_input(
      out.string(), "this is a folder; the result is one file", "name a file in it");
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/option_checks.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>

namespace marey::app {
namespace {

/// Returns the error for a word; empty if there is none. CLI11 rejects words that are not
/// numbers.
std::string number_problem(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (end == word.c_str()) return {};
  if (std::isnan(number)) return "Value " + word + " is not a number";
  if (!std::isfinite(number)) return "Value " + word + " is not finite";
  if (std::abs(number) > kMaxNumber) return "Value " + word + " is absurdly large";
  return {};
}

bool takes_a_float(const CLI::Option& option) {
  return option.get_type_name().find("FLOAT") != std::string::npos;
}

}  // namespace

void refuse_absurd_numbers(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (!takes_a_float(*option)) continue;
    option->check(
        CLI::Validator([](std::string& word) { return number_problem(word); }, ""));
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

}  // namespace marey::app

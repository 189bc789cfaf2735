// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/usage_error.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/nearest_word.h"

namespace marey::app {
namespace {

bool is_option(std::string_view word) {
  return word.size() > 1 && word[0] == '-' &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string nearest_of(std::string_view wrong, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return suggestion(wrong, views);
}

/// The words that no command or option took, in the order of the command line: CLI11
/// returns them in reverse.
std::vector<std::string> words_left(const CLI::App& app,
                                    std::span<const char* const> arguments) {
  std::vector<std::string> left = app.remaining(true);
  std::vector<std::string> ordered;
  for (const std::string_view word : arguments.subspan(1)) {
    const auto found = std::ranges::find(left, word);
    if (found == left.end()) continue;
    ordered.push_back(*found);
    left.erase(found);
  }
  ordered.insert(ordered.end(), left.begin(), left.end());
  return ordered;
}

Error refused(std::string where, std::string cause, std::string next) {
  return {Errc::kBadInput, std::move(where), std::move(cause), std::move(next)};
}

Error without_command(const CLI::App& app, const std::vector<std::string>& left) {
  const auto word = std::ranges::find_if_not(left, is_option);
  if (word != left.end()) {
    return refused(*word,
                   "there is no such command",
                   nearest_of(*word, names_of_commands(app)) +
                       "; marey --help describes the commands");
  }
  if (!left.empty()) {
    return refused(left.front(),
                   "there is no such option",
                   nearest_of(left.front(), names_of_options(app)) +
                       "; options of a command follow its name");
  }
  return refused(
      "marey",
      "no command is given",
      "run marey demo to see a whole session, or marey --help for the commands");
}

std::optional<Error> superfluous(const CLI::App& app,
                                 const CLI::App& command,
                                 const std::string& called,
                                 const std::vector<std::string>& left) {
  const auto option = std::ranges::find_if(left, is_option);
  if (option != left.end()) {
    const std::string name = option->substr(0, option->find('='));
    // Options of the program may follow a command.
    std::vector<std::string> known = names_of_options(command);
    for (std::string& other : names_of_options(app)) known.push_back(std::move(other));
    return refused(
        called,
        "there is no option " + name,
        nearest_of(name, known) + "; " + called + " --help describes the options");
  }
  if (left.empty()) return std::nullopt;
  std::string words;
  for (const std::string& word : left) words += " \"" + word + "\"";
  return refused(called,
                 "these arguments are too many:" + words,
                 "leave them out, and put paths with spaces in quotation marks; " +
                     called + " --help describes the arguments");
}

}  // namespace

Error usage_error(const CLI::App& app,
                  const CLI::ParseError& problem,
                  std::span<const char* const> arguments) {
  const std::vector<std::string> left = words_left(app, arguments);
  const std::string text = problem.what();
  const auto commands = app.get_subcommands();
  const std::string called =
      commands.empty() ? "marey" : "marey " + commands.front()->get_name();
  const bool is_about_a_value = problem.get_name() == "ValidationError" ||
                                problem.get_name() == "ConversionError" ||
                                problem.get_name() == "ArgumentMismatch";
  if (is_about_a_value) {
    return refused(called, text, called + " --help describes the values of options");
  }
  if (commands.empty()) return without_command(app, left);
  if (const auto error = superfluous(app, *commands.front(), called, left)) return *error;
  if (problem.get_name() == "ExcludesError") {
    return refused(called, text, "leave one of the two out");
  }
  return refused(called, text, "add it; " + called + " --help describes the arguments");
}

}  // namespace marey::app

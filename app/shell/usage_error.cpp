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

#include "app/shell/option_checks.h"
#include "core/base/in_quotes.h"
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

/// Appends the names of the options that are not in the list yet: every command has
/// --help.
void add_names_of_options(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // A former name.
    for (const std::string& name : option->get_lnames()) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
}

/// Returns the next step for a wrong word: the name that the user probably meant, else
/// the names if they are few, then `help`. `before` stands before each name.
std::string next_for(std::string_view wrong,
                     const std::vector<std::string>& names,
                     const std::string& before,
                     const std::string& help) {
  constexpr std::size_t kMaxListed = 8;
  const std::vector<std::string_view> views(names.begin(), names.end());
  if (const auto meant = meant_word(wrong, views)) {
    return std::string("perhaps you mean \"")
        .append(before)
        .append(*meant)
        .append("\"; ")
        .append(help);
  }
  if (names.size() > kMaxListed) return help;
  std::string list;
  for (const std::string& name : names) {
    list += (list.empty() ? "\"" : ", \"") + before + name + "\"";
  }
  return "choose one of " + list + "; " + help;
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

/// Returns the name of an option without its dashes and its value.
std::string bare_name(const std::string& option) {
  const std::string name = option.substr(0, option.find('='));
  return name.substr(std::min(name.find_first_not_of('-'), name.size()));
}

Error without_command(const CLI::App& app, const std::vector<std::string>& left) {
  if (!left.empty() && !is_option(left.front())) {
    return bad_usage(left.front(),
                     "there is no such command",
                     next_for(left.front(),
                              names_of_commands(app),
                              "",
                              "marey --help describes the commands"));
  }
  if (!left.empty()) {
    std::vector<std::string> known;
    add_names_of_options(app, known);
    return bad_usage(left.front(),
                     "there is no such option",
                     next_for(bare_name(left.front()),
                              known,
                              "--",
                              "options of a command follow its name"));
  }
  return bad_usage(
      "marey",
      "no command is given",
      "run marey demo to see a whole session, or marey --help for the commands");
}

/// The words of a command line that ended with an error.
struct RefusedCommand {
  const CLI::App& app;
  const CLI::App& command;
  std::string called;  ///< "marey process".

  [[nodiscard]] std::string help(std::string_view what) const {
    return (called + " --help describes the ").append(what);
  }
  /// Returns the options of the command, then those of the program.
  [[nodiscard]] std::vector<const CLI::Option*> options() const {
    std::vector<const CLI::Option*> all = command.get_options();
    for (const CLI::Option* option : app.get_options()) all.push_back(option);
    return all;
  }
};

std::optional<Error> superfluous(const RefusedCommand& refused,
                                 const std::vector<std::string>& left) {
  const auto option = std::ranges::find_if(left, is_option);
  if (option != left.end()) {
    // Options of the program may follow a command.
    std::vector<std::string> known;
    add_names_of_options(refused.command, known);
    add_names_of_options(refused.app, known);
    return bad_usage(refused.called,
                     "there is no option " + option->substr(0, option->find('=')),
                     next_for(bare_name(*option), known, "--", refused.help("options")));
  }
  if (left.empty()) return std::nullopt;
  std::string words;
  for (const std::string& word : left) words += " " + in_quotes(word);
  return bad_usage(refused.called,
                   "these arguments are too many:" + words,
                   "leave them out, and put paths with spaces in quotation marks; " +
                       refused.help("arguments"));
}

/// Returns the error for an argument that is required and missing.
std::optional<Error> missing(const RefusedCommand& refused) {
  for (const CLI::Option* option : refused.options()) {
    if (!option->get_required() || option->count() > 0) continue;
    const std::string name = option->get_name();
    const std::string& description = option->get_description();
    return bad_usage(
        refused.called,
        name + " is missing",
        "give " + name + ": " + description + "; " + refused.help("arguments"));
  }
  return std::nullopt;
}

/// Returns the name of an option, also of a hidden one, for which CLI11 returns none.
std::string name_with_dashes(const CLI::Option& option) {
  const std::vector<std::string>& names = option.get_lnames();
  return names.empty() ? option.get_name() : "--" + names.front();
}

/// Returns the error for two options that exclude each other.
std::optional<Error> excluded(const RefusedCommand& refused) {
  for (const CLI::Option* option : refused.options()) {
    if (option->count() == 0) continue;
    for (const CLI::Option* other : option->get_excludes()) {
      if (other->count() == 0) continue;
      return bad_usage(refused.called,
                       name_with_dashes(*option) + " and " + name_with_dashes(*other) +
                           " cannot be used together",
                       "leave one of the two out");
    }
  }
  return std::nullopt;
}

/// Returns the error for an option whose value is missing, superfluous or not allowed.
/// `text` is CLI11's, which begins with the option's name.
Error wrong_value(const RefusedCommand& refused,
                  const std::string& text,
                  bool is_about_a_count,
                  std::span<const char* const> arguments) {
  for (const CLI::Option* option : refused.options()) {
    const std::string name = option->get_name();
    const bool is_flag = option->get_items_expected_max() == 0;
    const bool has_value = std::ranges::any_of(
        arguments, [&](std::string_view word) { return word.starts_with(name + "="); });
    if (is_flag && has_value && text.find(name) != std::string::npos) {
      return bad_usage(refused.called,
                       name + " takes no value",
                       "give " + name + " alone; " + refused.help("options"));
    }
    if (!text.starts_with(name + ": ")) continue;
    if (!is_about_a_count) {
      return bad_usage(refused.called,
                       name + text.substr(name.size() + 1),
                       refused.help("values of options"));
    }
    const bool is_repeated = option->count() > 1;
    return bad_usage(refused.called,
                     name + (is_repeated ? " is given more than once" : " has no value"),
                     is_repeated ? "give it once; " + refused.help("options")
                                 : "give its value: " + option->get_description() + "; " +
                                       refused.help("options"));
  }
  return bad_usage(refused.called, text, refused.help("values of options"));
}

}  // namespace

Error usage_error(const CLI::App& app,
                  const CLI::ParseError& problem,
                  std::span<const char* const> arguments) {
  const std::vector<std::string> left = words_left(app, arguments);
  const auto commands = app.get_subcommands();
  const CLI::App& command = commands.empty() ? app : *commands.front();
  const RefusedCommand refused{
      app, command, commands.empty() ? "marey" : "marey " + command.get_name()};
  if (const auto* own = dynamic_cast<const RejectedArguments*>(&problem)) {
    return bad_usage(refused.called, own->what(), own->next());
  }
  const bool is_about_a_count = problem.get_name() == "ArgumentMismatch";
  const bool is_about_a_value = is_about_a_count ||
                                problem.get_name() == "ValidationError" ||
                                problem.get_name() == "ConversionError";
  if (is_about_a_value) {
    return wrong_value(refused, problem.what(), is_about_a_count, arguments);
  }
  if (commands.empty()) return without_command(app, left);
  if (const auto error = superfluous(refused, left)) return *error;
  if (problem.get_name() == "ExcludesError") {
    if (const auto error = excluded(refused)) return *error;
  }
  if (const auto error = missing(refused)) return *error;
  return bad_usage(refused.called, problem.what(), refused.help("arguments"));
}

}  // namespace marey::app

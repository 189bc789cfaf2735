// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/program_name.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

namespace marey::app {
namespace {

constexpr std::string_view kName = "marey";

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_-./=:,+@%").find(c) != std::string_view::npos;
}

std::string shell_word(const std::string& word) {
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

}  // namespace

std::string shell_command(const std::vector<std::string>& words) {
  std::string command;
  for (const std::string& word : words) {
    if (!command.empty()) command += ' ';
    command += shell_word(word);
  }
  return command;
}

ProgramName::ProgramName(const std::string& called, std::vector<std::string> commands)
    : called_(called.empty() ? std::string(kName) : shell_word(called)),
      commands_(std::move(commands)) {}

bool ProgramName::is_command(const std::string& text, std::size_t begin) const {
  constexpr std::string_view kBefore = " `\"(";
  if (begin > 0 && kBefore.find(text[begin - 1]) == std::string_view::npos) return false;
  const std::size_t word = begin + kName.size() + 1;
  if (word >= text.size() || text[word - 1] != ' ') return false;
  std::size_t end = word;
  const auto is_in_word = [](char c) {
    return c == '-' || std::islower(static_cast<unsigned char>(c)) != 0;
  };
  while (end < text.size() && is_in_word(text[end])) ++end;
  return std::ranges::find(commands_, text.substr(word, end - word)) != commands_.end();
}

std::string ProgramName::written_into(const std::string& text) const {
  std::string out;
  std::size_t copied = 0;
  for (std::size_t found = text.find(kName); found != std::string::npos;
       found = text.find(kName, found + 1)) {
    if (!is_command(text, found)) continue;
    out.append(text, copied, found - copied);
    out += called_;
    copied = found + kName.size();
  }
  return out.append(text, copied);
}

}  // namespace marey::app

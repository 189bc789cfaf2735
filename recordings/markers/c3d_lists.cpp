// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Search of parameters by name, and lists that extend over several parameters.
#include <algorithm>
#include <cctype>
#include <utility>

#include "recordings/markers/c3d.h"

namespace marey::recordings {
namespace {

/// Limit of one parameter's dimension.
constexpr std::size_t kMaxInOne = 255;

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return upper(x) == upper(y);
  });
}

void append_texts(std::vector<std::string>& list, const C3dParameter& parameter) {
  const auto* text = std::get_if<C3dText>(&parameter.values);
  if (text == nullptr) return;
  std::size_t length = 1;
  std::size_t count = 1;
  if (!parameter.dimensions.empty()) length = parameter.dimensions[0];
  for (std::size_t i = 1; i < parameter.dimensions.size(); ++i) {
    count *= parameter.dimensions[i];
  }
  // A texts' length of 0: the count is limited to the maximum of one list.
  if (length == 0) count = std::min(count, kMaxInOne);
  for (std::size_t i = 0; i < count; ++i) {
    std::string one =
        text->characters.substr(std::min(i * length, text->characters.size()), length);
    one = one.substr(0, one.find('\0'));
    while (!one.empty() && static_cast<unsigned char>(one.back()) <= ' ') one.pop_back();
    list.push_back(std::move(one));
  }
}

void append_numbers(std::vector<double>& list, const C3dParameter& p, bool is_unsigned) {
  if (const auto* bytes = std::get_if<C3dBytes>(&p.values)) {
    list.insert(list.end(), bytes->begin(), bytes->end());
  } else if (const auto* reals = std::get_if<C3dReals>(&p.values)) {
    list.insert(list.end(), reals->begin(), reals->end());
  } else if (const auto* integers = std::get_if<C3dIntegers>(&p.values)) {
    for (const std::int16_t value : *integers) {
      list.push_back(is_unsigned ? static_cast<double>(static_cast<std::uint16_t>(value))
                                 : static_cast<double>(value));
    }
  }
}

/// Visits NAME, NAME2, NAME3... until one is missing.
template <class Visit>
void visit_pieces(const std::vector<C3dGroup>& groups,
                  std::string_view group,
                  std::string_view name,
                  const Visit& visit) {
  for (int piece = 1;; ++piece) {
    std::string full(name);
    if (piece > 1) full += std::to_string(piece);
    const C3dParameter* parameter = find_parameter(groups, group, full);
    if (parameter == nullptr) return;
    visit(*parameter);
  }
}

}  // namespace

const C3dParameter* find_parameter(const std::vector<C3dGroup>& groups,
                                   std::string_view group,
                                   std::string_view name) {
  for (const C3dGroup& candidate : groups) {
    if (!same_name(candidate.name, group)) continue;
    for (const C3dParameter& parameter : candidate.parameters) {
      if (same_name(parameter.name, name)) return &parameter;
    }
  }
  return nullptr;
}

std::vector<std::string> texts(const C3dParameter& parameter) {
  std::vector<std::string> list;
  append_texts(list, parameter);
  return list;
}

std::vector<double> numbers(const C3dParameter& parameter, bool is_unsigned) {
  std::vector<double> list;
  append_numbers(list, parameter, is_unsigned);
  return list;
}

std::vector<std::string> texts_of_all(const std::vector<C3dGroup>& groups,
                                      std::string_view group,
                                      std::string_view name) {
  std::vector<std::string> list;
  visit_pieces(
      groups, group, name, [&](const C3dParameter& p) { append_texts(list, p); });
  return list;
}

std::vector<double> numbers_of_all(const std::vector<C3dGroup>& groups,
                                   std::string_view group,
                                   std::string_view name,
                                   bool is_unsigned) {
  std::vector<double> list;
  visit_pieces(groups, group, name, [&](const C3dParameter& p) {
    append_numbers(list, p, is_unsigned);
  });
  return list;
}

void put_parameter(std::vector<C3dGroup>& groups,
                   std::string_view group,
                   C3dParameter parameter) {
  auto found = std::find_if(groups.begin(), groups.end(), [&](const C3dGroup& g) {
    return same_name(g.name, group);
  });
  if (found == groups.end()) {
    C3dGroup fresh;
    fresh.name = group;
    std::uint8_t free_id = 1;
    const auto taken = [&](const C3dGroup& g) { return g.id == free_id; };
    while (free_id < 127 && std::any_of(groups.begin(), groups.end(), taken)) ++free_id;
    fresh.id = free_id;
    groups.push_back(std::move(fresh));
    found = groups.end() - 1;
  }
  for (C3dParameter& old : found->parameters) {
    if (!same_name(old.name, parameter.name)) continue;
    old.dimensions = std::move(parameter.dimensions);
    old.values = std::move(parameter.values);
    if (!parameter.description.empty()) {
      old.description = std::move(parameter.description);
    }
    return;
  }
  found->parameters.push_back(std::move(parameter));
}

void put_texts(std::vector<C3dGroup>& groups,
               std::string_view group,
               std::string_view name,
               const std::vector<std::string>& list) {
  std::size_t length = 4;
  for (const std::string& text : list) {
    length = std::max(length, std::min(text.size(), kMaxInOne));
  }
  std::size_t done = 0;
  for (int piece = 1; piece == 1 || done < list.size(); ++piece) {
    // The length of a record has 16 bits.
    const std::size_t max_count = std::min(kMaxInOne, std::size_t{65000} / length);
    const std::size_t count = std::min(max_count, list.size() - done);
    C3dParameter p;
    p.name = std::string(name) + (piece == 1 ? "" : std::to_string(piece));
    p.dimensions = {static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(count)};
    C3dText text;
    for (std::size_t i = 0; i < count; ++i) {
      std::string one = list[done + i].substr(0, length);
      one.resize(length, ' ');
      text.characters += one;
    }
    p.values = std::move(text);
    put_parameter(groups, group, std::move(p));
    done += count;
  }
}

}  // namespace marey::recordings

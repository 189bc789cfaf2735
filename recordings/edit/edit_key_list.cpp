// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_key_list.h"

#include <type_traits>
#include <variant>

#include "recordings/edit/edit_keys.h"
#include "recordings/edit/edit_rotation_keys.h"
#include "recordings/edit/edit_value_keys.h"

namespace marey::recordings::recipe {

void KeyList::add_moment(std::string_view key) {
  for (std::string& one : moment_keys(key)) keys_.push_back(std::move(one));
}

void KeyList::add_rotation(std::string_view key) {
  for (std::string& one : rotation_keys(key)) keys_.push_back(std::move(one));
}

std::vector<std::string> edit_op_keys(const EditOpParameters& parameters) {
  KeyList list;
  list.boolean("do");
  list.boolean("off");
  list.boolean("why");
  visit_keys(list, KeysOf<EditSpan>{});
  list.boolean("groups");
  list.boolean("blend_s");
  std::visit(
      [&](const auto& op) { visit_keys(list, KeysOf<std::decay_t<decltype(op)>>{}); },
      parameters);
  return list.keys();
}

}  // namespace marey::recordings::recipe

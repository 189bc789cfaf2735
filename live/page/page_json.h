// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "core/transform.h"

namespace marey::live {

/// JSON whose members keep the order in which they are written.
using PageJson = nlohmann::ordered_json;

/// Returns the JSON in one line. Invalid UTF-8 is replaced; non-finite numbers are null.
[[nodiscard]] inline std::string in_one_line(const PageJson& json) {
  return json.dump(-1, ' ', false, PageJson::error_handler_t::replace);
}

[[nodiscard]] inline PageJson to_json(const glm::dvec3& v) {
  return PageJson::array({v.x, v.y, v.z});
}

[[nodiscard]] inline PageJson to_json(const glm::dquat& q) {
  return PageJson::array({q.x, q.y, q.z, q.w});
}

[[nodiscard]] inline PageJson to_json(const RigidTransform& t) {
  return {{"p", to_json(t.translation)}, {"q", to_json(t.rotation)}};
}

template <class T>
[[nodiscard]] PageJson or_null(const std::optional<T>& value) {
  return value ? PageJson(*value) : PageJson();
}

/// Returns an array with one(item) for each item of `list`.
template <class List, class One>
[[nodiscard]] PageJson array_of(const List& list, const One& one) {
  PageJson out = PageJson::array();
  for (const auto& item : list) out.push_back(one(item));
  return out;
}

}  // namespace marey::live

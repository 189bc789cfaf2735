// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/edit/edit_ops.h"

#include <array>
#include <cstddef>
#include <utility>

namespace marey {
namespace {

constexpr std::size_t kOps = std::variant_size_v<EditOpParameters>;

constexpr std::array<std::string_view, kOps> kOpNames{
    "cut",      "keep",      "split",  "splice", "filter",     "level",
    "place",    "path",      "mirror", "retime", "cyclify",    "plant",
    "contacts", "constrain", "pose",   "offset", "scale_time", "exaggerate",
    "jump",     "balance",   "tag",    "event",  "curve",      "retarget"};

template <std::size_t... I>
EditOpParameters op_at(std::size_t place, std::index_sequence<I...>) {
  EditOpParameters out;
  ((place == I ? void(out.emplace<I>()) : void()), ...);
  return out;
}

}  // namespace

std::string_view name(const EditOpParameters& parameters) {
  return kOpNames[parameters.index()];
}

std::optional<EditOpParameters> edit_op(std::string_view op_name) {
  for (std::size_t i = 0; i < kOps; ++i) {
    if (kOpNames[i] == op_name) return op_at(i, std::make_index_sequence<kOps>{});
  }
  return std::nullopt;
}

std::vector<std::string_view> edit_op_names() {
  return {kOpNames.begin(), kOpNames.end()};
}

}  // namespace marey

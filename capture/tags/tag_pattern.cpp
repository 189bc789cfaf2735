// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/tag_pattern.h"

#include <memory>
#include <string>

#include "capture/tags/aruco_dictionary.h"
#include "capture/tags/tag_families.h"
#include "core/base/assert.h"

namespace marey::capture {
namespace {

using OwnedFamily = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

TagFamilyShape shape_of(const FamilyMaker& maker, const apriltag_family_t& family) {
  return {std::string(maker.name),
          static_cast<int>(family.ncodes),
          family.total_width,
          family.width_at_border,
          family.reversed_border};
}

}  // namespace

Result<TagFamilyShape> tag_family_shape(std::string_view name) {
  const FamilyMaker* maker = find_family(name);
  if (maker == nullptr) return unknown_family(name);
  const OwnedFamily family(maker->create(), maker->destroy);
  return shape_of(*maker, *family);
}

Result<std::vector<TagPattern>> tag_patterns(std::string_view name,
                                             std::span<const TagId> ids) {
  const FamilyMaker* maker = find_family(name);
  if (maker == nullptr) return unknown_family(name);
  const OwnedFamily family(maker->create(), maker->destroy);
  const int last = static_cast<int>(family->ncodes) - 1;
  std::vector<TagPattern> patterns;
  for (const TagId id : ids) {
    if (number(id) < 0 || number(id) > last) {
      return bad_input(
          "tag " + std::to_string(number(id)),
          std::string(name) + " ends at id " + std::to_string(last),
          "choose ids from 0 to " + std::to_string(last) + ", or a family with more");
    }
    patterns.push_back(pattern_of(family.get(), id));
  }
  return patterns;
}

Result<std::vector<TagPattern>> aruco_patterns(std::string_view dictionary, int count) {
  MAREY_ASSERT(count >= 0);
  const auto markers = aruco_dictionary(dictionary, count);
  if (!markers) return markers.error();
  std::vector<TagPattern> patterns;
  for (int id = 0; id < count; ++id) patterns.push_back(marker_pattern(*markers, id));
  return patterns;
}

}  // namespace marey::capture

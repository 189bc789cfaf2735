// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/tag_families.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

#include "core/base/assert.h"
#include "core/tag_family.h"

namespace marey::capture {
namespace {

/// Creates tag36h11 with a black frame of two cells, as on Kalibr's boards.
apriltag_family_t* create_tag36h11b2() {
  apriltag_family_t* family = tag36h11_create();
  family->width_at_border += 2;
  family->total_width += 2;
  for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
    ++family->bit_x[bit];
    ++family->bit_y[bit];
  }
  return family;
}

constexpr std::array<FamilyMaker, kTagFamilies.size()> kFamilies{{
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag36h11b2", create_tag36h11b2, tag36h11_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
}};

/// Whitens cells that are neither a bit nor part of the square and the ring around it.
void whiten_unused(const apriltag_family_t& family, TagPattern& pattern) {
  // First cell of the ring around the square.
  const int first = pattern.margin_cells - 1;
  const int last = pattern.cells - pattern.margin_cells;
  const auto place = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(pattern.cells) +
           static_cast<std::size_t>(x);
  };
  std::vector<bool> used(pattern.white.size(), false);
  for (std::uint32_t bit = 0; bit < family.nbits; ++bit) {
    used[place(static_cast<int>(family.bit_x[bit]) + pattern.margin_cells,
               static_cast<int>(family.bit_y[bit]) + pattern.margin_cells)] = true;
  }
  for (int y = 0; y < pattern.cells; ++y) {
    for (int x = 0; x < pattern.cells; ++x) {
      const bool inside = std::min(x, y) >= first && std::max(x, y) <= last;
      if (!inside && !used[place(x, y)]) pattern.white[place(x, y)] = 1;
    }
  }
}

}  // namespace

const FamilyMaker* find_family(std::string_view name) {
  const auto found = std::find_if(
      kFamilies.begin(), kFamilies.end(), [&](const auto& f) { return f.name == name; });
  return found == kFamilies.end() ? nullptr : &*found;
}

Error unknown_family(std::string_view name) {
  std::string known;
  for (const FamilyMaker& family : kFamilies) {
    known.append(known.empty() ? "" : ", ").append(family.name);
  }
  return bad_input("tag family",
                   std::string("\"").append(name).append("\" is not known"),
                   "use one of " + known);
}

TagPattern pattern_of(apriltag_family_t* family, TagId id) {
  MAREY_ASSERT(number(id) >= 0 &&
               static_cast<std::uint32_t>(number(id)) < family->ncodes);
  image_u8_t* image = apriltag_to_image(family, static_cast<std::uint32_t>(number(id)));
  TagPattern pattern;
  pattern.cells = image->width;
  pattern.margin_cells = (family->total_width - family->width_at_border) / 2;
  for (int y = 0; y < image->height; ++y) {
    const std::uint8_t* row = image->buf + static_cast<std::ptrdiff_t>(y) * image->stride;
    for (int x = 0; x < image->width; ++x) pattern.white.push_back(row[x] != 0 ? 1 : 0);
  }
  image_u8_destroy(image);
  whiten_unused(*family, pattern);
  return pattern;
}

}  // namespace marey::capture

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session_family.h"

#include <algorithm>
#include <array>
#include <vector>

#include "recordings/nearest_word.h"

namespace marey::recordings {
namespace {

/// How many tags each has: apriltag 3.3, ncodes.
constexpr std::array<KnownFamily, 10> kFamilies{{
    {"tag36h11", 587},
    {"tag36h11b2", 587},
    {"tag25h9", 35},
    {"tag16h5", 30},
    {"tag36h10", 2320},
    {"tagStandard41h12", 2115},
    {"tagCircle21h7", 38},
    {"tagCircle49h12", 65535},
    {"tagCustom48h12", 42211},
    {"tagStandard52h13", 48714},
}};

}  // namespace

KnownFamily usual_family() {
  return kFamilies[0];
}

KnownFamily read_family(TomlReader& reader, const KnownFamily& usual) {
  if (!reader.has("family")) return usual;
  const std::string word = reader.text("family");
  std::vector<std::string_view> names;
  for (const KnownFamily& family : kFamilies) {
    if (family.name == word) return family;
    names.push_back(family.name);
  }
  reader.fail("family", "unknown tag family " + in_quotes(word), suggestion(word, names));
  return usual;
}

void use_tag(const KnownFamily& family, TagId id, Session& session) {
  const auto same = std::find_if(
      session.families.begin(), session.families.end(), [&](const TagFamilyUse& use) {
        return use.name == family.name;
      });
  if (same != session.families.end()) {
    same->ids.push_back(id);
  } else {
    session.families.push_back({std::string(family.name), {id}});
  }
}

}  // namespace marey::recordings

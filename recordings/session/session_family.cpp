// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session_family.h"

#include <algorithm>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"

namespace marey::recordings {

KnownFamily default_family() {
  return kTagFamilies[0];
}

KnownFamily read_family(TomlReader& reader, const KnownFamily& usual) {
  if (!reader.has("family")) return usual;
  const std::string word = reader.text("family");
  std::vector<std::string_view> names;
  for (const KnownFamily& family : kTagFamilies) {
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

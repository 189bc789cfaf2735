// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/marker_map.h"

#include <utility>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings {

Result<MarkerMap> parse_marker_map(std::string_view text, const std::string& file) {
  Result<TomlDocument> document = parse_toml(text, file, "markers.md");
  if (!document) return document.error();
  TomlReader root(*document);
  root.allow({"markers"});
  TomlReader markers = root.table("markers");
  MarkerMap map{file, {}};
  for (const std::string& label : markers.keys()) {
    if (markers.is_table(label)) {  // In TOML, R.ASIS = "right_asis" is a table R.
      markers.fail(
          label,
          in_quotes(label) + " must be text in quotes",
          "write labels that have a point in quotes: \"R.ASIS\" = \"right_asis\"");
    }
    std::string name = markers.text(label);
    if (name == "ignore") name.clear();
    map.entries.push_back({label, std::move(name), markers.line(label)});
  }
  if (map.entries.empty()) {
    root.fail("markers",
              "no label in [markers]",
              "add a line for each marker: LASI = \"left_asis\"");
  }
  if (document->mistake) return mistake_of(*document, TomlKind::kMarkerMap);
  return map;
}

Result<MarkerMap> read_marker_map(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_marker_map(*text, path.string());
}

}  // namespace marey::recordings

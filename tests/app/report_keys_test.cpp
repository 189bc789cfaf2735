// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/report_figures.h"
#include "tests/app/sample_report.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

void collect_keys(const Json& value, std::set<std::string>& keys) {
  if (value.is_object()) {
    for (const auto& [key, below] : value.items()) {
      keys.insert(key);
      collect_keys(below, keys);
    }
  } else if (value.is_array()) {
    for (const Json& below : value) collect_keys(below, keys);
  }
}

/// The page's section on report.json: from its heading to the next.
std::string section_of_the_page() {
  std::ostringstream page;
  page << std::ifstream(std::filesystem::path(MAREY_SOURCE_DIR) / "docs/formats.md")
              .rdbuf();
  const std::string text = page.str();
  const std::size_t start = text.find("### report.json\n");
  if (start == std::string::npos) return "";
  const std::size_t end = text.find("\n### ", start);
  return text.substr(start, end == std::string::npos ? end : end - start);
}

TEST(ReportKeys, AreAllOnTheFormatsPage) {
  const std::string section = section_of_the_page();
  std::set<std::string> keys;
  collect_keys(report_figures(report()), keys);
  // As many as the sample report holds of everything: far more than the top level's.
  EXPECT_GT(keys.size(), 50U);
  for (const std::string& key : keys) {
    EXPECT_NE(section.find('`' + key + '`'), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace marey::app

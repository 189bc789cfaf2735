// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/program/paths.h"

#include <fstream>
#include <sstream>

namespace marey::testing {

std::filesystem::path source_dir() {
  return MAREY_SOURCE_DIR;
}

std::filesystem::path shared_data() {
  return MAREY_SHARED_DATA;
}

std::string program() {
  return MAREY_PROGRAM;
}

std::filesystem::path sample_session() {
  return source_dir() / "recordings/samples/first-light";
}

std::filesystem::path sample_results() {
  return MAREY_SAMPLE_RESULTS;
}

std::string pdftoppm() {
  std::string path = MAREY_PDFTOPPM;
  return path.find("NOTFOUND") == std::string::npos ? path : "";
}

std::string formats_page(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(source_dir() / "docs/formats" / (name + ".md")).rdbuf();
  return text.str();
}

std::string formats_example(const std::string& name, const std::string& start) {
  const std::string page = formats_page(name);
  const std::string fence = "```toml\n";
  const std::size_t found = page.find(fence + start);
  if (found == std::string::npos) return "";
  const std::size_t begin = found + fence.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

}  // namespace marey::testing

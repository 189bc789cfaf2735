// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"
#include "tests/app/pages/collect_keys.h"
#include "tests/app/pages/sample_report.h"
#include "tests/support/program/paths.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

TEST(ReportKeys, AreAllOnTheFormatsPage) {
  const std::string section = marey::testing::formats_page("report");
  std::set<std::string> keys;
  collect_keys(report_json(report()), keys);
  // As many as the sample report holds of everything: far more than the top level's.
  EXPECT_GT(keys.size(), 50U);
  for (const std::string& key : keys) {
    EXPECT_NE(section.find('`' + key + '`'), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace marey::app

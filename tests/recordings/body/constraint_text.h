// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/body/constraints_file.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"

namespace marey::testing {

inline const std::string kAnnex =
    marey::testing::source_dir() / "tests/data/annex_a_constraints.xml";

inline std::string refusal(const std::string& text) {
  const auto file = recordings::parse_constraints(text, "c.xml");
  return file ? "no refusal" : file.error().message();
}

inline std::string annex() {
  const Result<std::string> text = recordings::read_file(kAnnex);
  EXPECT_TRUE(text);
  return text ? *text : "";
}

inline std::string annex_with(const std::string& from, const std::string& to) {
  return replace_first(annex(), from, to);
}

}  // namespace marey::testing

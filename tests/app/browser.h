// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {

inline constexpr const char* kBrowser = "/usr/bin/chromium";

/// A page after its scripts ran, and the browser's console output.
struct ShownPage {
  std::string page;
  std::string console;

  /// The value of an attribute data-`name` of <html>; empty without.
  [[nodiscard]] std::string status(const std::string& name) const {
    const std::string start = "data-" + name + "=\"";
    const std::size_t at = page.find(start);
    if (at == std::string::npos) return "";
    const std::size_t from = at + start.size();
    return page.substr(from, page.find('"', from) - from);
  }
};

/// Opens a page in a headless browser; `wishes` is the part of its address after #.
inline ShownPage show_page(const std::string& html, const std::string& wishes) {
  const ScratchFolder folder;
  std::ofstream(folder / "page.html") << html;
  const std::string command =
      "cd '" + folder.path().string() + "' && timeout 120 " + kBrowser +
      " --headless --no-sandbox --disable-quic --no-first-run"
      " --disable-background-networking --disable-component-update --disable-sync"
      " --use-angle=swiftshader --enable-unsafe-swiftshader --window-size=1280,900"
      " --enable-logging=stderr --user-data-dir=profile --virtual-time-budget=5000"
      " --dump-dom 'file://" +
      (folder / "page.html").string() + "#" + wishes + "' > page 2> console";
  // A crash or a hang of the browser is no result of the page: the browser starts again.
  if (std::system(command.c_str()) != 0) {
    std::filesystem::remove_all(folder / "profile");
    EXPECT_EQ(std::system(command.c_str()), 0);
  }
  return {read_text(folder / "page"), read_text(folder / "console")};
}

/// Skips where there is no browser.
class InABrowser : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef MAREY_PLAIN_PAGES
    GTEST_SKIP() << "built with -DMAREY_VIEWER=OFF, without the pages of the reports";
#endif
    if (!std::filesystem::exists(kBrowser)) {
      GTEST_SKIP() << kBrowser << " is missing; apt-get install chromium";
    }
  }
};

}  // namespace marey::testing

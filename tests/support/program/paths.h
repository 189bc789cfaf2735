// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace marey::testing {

/// Paths that tests and benchmarks need. They are functions of one source file, not
/// macros in each test: a compiler then knows no path's length, and its warnings do not
/// depend on the folder of the checkout.

/// Returns the top folder of the source tree.
[[nodiscard]] std::filesystem::path source_dir();

/// Returns the folder of recordings with ground truth. It may not exist.
[[nodiscard]] std::filesystem::path shared_data();

/// Returns the path of the program marey of this build.
[[nodiscard]] std::string program();

/// Returns the folder of the sample session.
[[nodiscard]] std::filesystem::path sample_session();

/// Returns the folder that holds the results of the sample session, one folder per run of
/// the test fixtures in tests/app/CMakeLists.txt.
[[nodiscard]] std::filesystem::path sample_results();

/// Returns the path of pdftoppm; an empty string if it is not installed.
[[nodiscard]] std::string pdftoppm();

/// Returns the text of docs/formats/NAME.md; an empty string if the page does not exist.
[[nodiscard]] std::string formats_page(const std::string& name);

/// Returns the first example in TOML on docs/formats/NAME.md that begins with `start`; an
/// empty string if there is none.
[[nodiscard]] std::string formats_example(const std::string& name,
                                          const std::string& start = "");

}  // namespace marey::testing

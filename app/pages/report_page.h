// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace marey::app {

// Pages of live/viewer that are built into the program (app/pages/embed.cmake).

/// Returns the shell of a session's report, with the places {{style}}, {{data}} and
/// {{script}}.
[[nodiscard]] std::string_view report_page();

/// Returns the style that all reports share.
[[nodiscard]] std::string_view report_style();

/// Returns the bundled script. Empty in a build with -DMAREY_VIEWER=OFF, whose pages
/// state this.
[[nodiscard]] std::string_view report_script();

// The same for the page of a calibration. Its style is in addition to report_style().
[[nodiscard]] std::string_view calibration_page();
[[nodiscard]] std::string_view calibration_style();
[[nodiscard]] std::string_view calibration_script();

// The same for the pages of labelled markers.
[[nodiscard]] std::string_view markers_page();
[[nodiscard]] std::string_view markers_style();
[[nodiscard]] std::string_view markers_script();

// The same for the page of a library's check.
[[nodiscard]] std::string_view library_check_page();
[[nodiscard]] std::string_view library_check_style();
[[nodiscard]] std::string_view library_check_script();

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace marey::app {

// Files of app/report/ that are built into the program (app/report/embed.cmake).

/// Returns report.html, with the places {{style}}, {{data}} and {{script}}.
[[nodiscard]] std::string_view report_page();

/// Returns report.css.
[[nodiscard]] std::string_view report_style();

/// Returns the .js files, one after the other, in one common scope.
[[nodiscard]] std::string_view report_script();

// The same for the page of a calibration: calibration.html, calibration.css after
// report.css, and the .js files that this page needs.
[[nodiscard]] std::string_view calibration_page();
[[nodiscard]] std::string_view calibration_style();
[[nodiscard]] std::string_view calibration_script();

// The same for the pages of labelled markers: markers.html, markers.css after report.css.
[[nodiscard]] std::string_view markers_page();
[[nodiscard]] std::string_view markers_style();
[[nodiscard]] std::string_view markers_script();

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/plan/plan_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "app/pages/page_text.h"
#include "app/pages/report_page.h"
#include "app/plan/plan_map.h"
#include "core/base/quantile.h"

namespace marey::app {
namespace {

/// Added to the style of the report's page (live/viewer/src/styles/report.css).
constexpr std::string_view kStyle = R"(
main { padding-bottom: 2rem; }
.maps { display: grid; gap: 1.4rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr)); }
.map svg { display: block; width: 100%; background: var(--card); border: 1px solid var(--rule); border-radius: 10px; }
.map .sight { fill: var(--measured); fill-opacity: 0.07; }
.map .cone { fill: none; stroke: var(--ink); stroke-opacity: 0.45; stroke-dasharray: 5 4; vector-effect: non-scaling-stroke; }
.map .unseen-cell { fill: var(--seen-none); }
.map .metre { stroke: var(--rule); vector-effect: non-scaling-stroke; }
.map .body { fill: var(--ink); stroke: var(--card); stroke-width: 1.5px; vector-effect: non-scaling-stroke; stroke-linejoin: round; }
.map text { fill: var(--ink); text-anchor: middle; paint-order: stroke; stroke: var(--card); stroke-width: 0.05px; font-weight: 600; }
.key { display: flex; gap: 0.6rem; align-items: center; font-size: 0.85rem; color: var(--quiet); margin: 0.2rem 0 1rem; flex-wrap: wrap; }
.key .ramp { width: 12rem; height: 0.8rem; border-radius: 3px; }
.key .swatch { border: 1px solid var(--rule); margin-left: 1rem; }
)";

/// Share of the scale at a place (nullopt: none), and its text.
using Shade = std::function<std::optional<double>(const calib::PlannedPlace&)>;

std::string words_of(const calib::PlannedPlace& place) {
  std::string out =
      text_of("x %.2f, z %.2f m: ", place.p_in_world.x, place.p_in_world.z) +
      text_of("%.0f %% seen by two, %.0f %% by one",
              100.0 * place.measured_share,
              100.0 * place.seen_share);
  if (!place.centre_error_m) return out;
  return out + text_of(", tag %.2f mm, joint %.2f mm, side %.0f px",
                       1e3 * *place.centre_error_m,
                       1e3 * *place.joint_error_m,
                       place.side_px);
}

std::vector<MapCell> cells_of(const PlanReport& report,
                              std::size_t height,
                              const Shade& shade) {
  const std::size_t count = report.plan.places.size() / report.plan.heights.size();
  std::vector<MapCell> cells;
  for (std::size_t i = height * count; i < (height + 1) * count; ++i) {
    const calib::PlannedPlace& place = report.plan.places[i];
    cells.push_back(
        {{place.p_in_world.x, place.p_in_world.z}, shade(place), words_of(place)});
  }
  return cells;
}

/// Returns the cells of a map of the body: the error of its joints, or the share of
/// measured joints.
std::vector<MapCell> stands_of(const PlanReport& report, bool error, double worst_m) {
  std::vector<MapCell> cells;
  for (const calib::PlannedStand& stand : report.body.stands) {
    MapCell cell{{stand.p_on_floor.x, stand.p_on_floor.z}, std::nullopt, ""};
    cell.words = text_of("x %.2f, z %.2f m: ", stand.p_on_floor.x, stand.p_on_floor.z) +
                 text_of("%.0f %% of joints measured", 100.0 * stand.measured_share);
    if (stand.error_m) {
      cell.words += text_of(", error %.1f mm", 1e3 * *stand.error_m);
      cell.share = error ? *stand.error_m / worst_m : 1.0 - stand.measured_share;
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

/// Rounds up to a number of one digit: 1, 2, 5, 10, 20...
double round_above(double value) {
  double step = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-6))));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * step >= value) return factor * step;
  }
  return 10.0 * step;
}

/// Returns the error at the top of the scale: the largest 95 % quantile of all heights.
/// [m]
double scale_of(const calib::RigPlan& plan) {
  double worst_m = 0.0;
  for (const auto& height : plan.heights) {
    if (height.centre_error_m) worst_m = std::max(worst_m, height.centre_error_m->p95);
  }
  return worst_m > 0.0 ? round_above(worst_m) : 1e-3;
}

/// Returns the top of the scale for the joints of the body: the 90 % quantile. Places
/// where the body is hardly seen exceed the scale. [m]
double worst_stand(const calib::BodyPlan& body) {
  std::vector<double> errors_m;
  for (const calib::PlannedStand& stand : body.stands) {
    if (stand.error_m) errors_m.push_back(*stand.error_m);
  }
  return errors_m.empty() ? 1e-3 : round_above(quantile(std::move(errors_m), 0.9));
}

/// Returns the top of the scale of directions: two cameras rarely share all directions.
double max_covered(const calib::RigPlan& plan) {
  double max_share = 0.1;
  for (const calib::PlannedPlace& place : plan.places) {
    max_share = std::max(max_share, place.measured_share);
  }
  return std::ceil(10.0 * max_share) / 10.0;
}

std::string key(const std::string& what,
                const std::string& low,
                const std::string& high,
                const std::string& none = "never seen by two") {
  std::string stops;
  for (int i = 0; i <= 5; ++i) stops += ", " + colour(i / 5.0);
  return "<p class=\"key\"><span>" + what + "</span> <span>" + low +
         "</span> <span class=\"ramp\" style=\"background: linear-gradient(to right" +
         stops + ")\"></span> <span>" + high +
         "</span> <span class=\"swatch\" style=\"background: var(--seen-none)\"></span> "
         "<span>" +
         none + "</span></p>\n";
}

std::string cell_mm(const std::optional<calib::MedianAndP95>& error_m) {
  if (!error_m) return "<td class=\"number\">–</td>";
  return text_of("<td class=\"number\">%.2f mm (95 %%: %.2f)</td>",
                 1e3 * error_m->median,
                 1e3 * error_m->p95);
}

std::string table_of(const PlanReport& report) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>Height</th>"
      "<th class=\"number\">Seen by one or more</th>"
      "<th class=\"number\">Seen by two or more</th><th class=\"number\">Side of a "
      "tag</th>"
      "<th class=\"number\">Error of a tag's centre</th>"
      "<th class=\"number\">Error of a joint</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < report.plan.heights.size(); ++i) {
    const calib::PlannedHeight& h = report.plan.heights[i];
    out += "<tr><th>" + escaped(report.height_names[i]) +
           text_of(", %.2f m</th><td class=\"number\">%.0f %%</td>",
                   h.height_m,
                   100.0 * h.seen_share) +
           text_of("<td class=\"number\">%.0f %%</td>", 100.0 * h.measured_share) +
           (h.side_px ? text_of("<td class=\"number\">%.0f px</td>", *h.side_px)
                      : "<td class=\"number\">–</td>") +
           cell_mm(h.centre_error_m) + cell_mm(h.joint_error_m) + "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string known_words(const PlanReport& report) {
  if (report.centre_sigma_m.empty()) return "The cameras are taken as exact.";
  const auto worst =
      std::max_element(report.centre_sigma_m.begin(), report.centre_sigma_m.end());
  return text_of(
      report.is_calibrated
          ? "The errors of the cameras are those of their calibration. The centre of "
            "the worst one has a standard deviation of %.1f mm."
          : "The errors of the cameras are predicted for a board waved through the "
            "volume. The centre of the worst one is known to %.1f mm (standard "
            "deviation).",
      1e3 * *worst);
}

std::string body_section(const PlanReport& report) {
  const calib::BodyPlan& body = report.body;
  std::string out = text_of(
      "<h2>A body that walks</h2>\n<p class=\"about\">It wears %.0f tags and "
      "walks through the volume in all directions; its soft tissue hides tags. It is "
      "found "
      "in %.0f %% of frames. Measured: a tag of the bone is seen by a camera. "
      "Lasting: errors of the measured body and cameras, which do not average out "
      "over frames. Movement of the skin is not included.</p>\n",
      report.tags_worn,
      100.0 * body.found_share);
  if (body.joints.empty()) return out;
  out +=
      "<div class=\"scroll\"><table><thead><tr><th>Joint</th><th "
      "class=\"number\">Measured</th><th class=\"number\">Error, median</th><th "
      "class=\"number\">95 %</th><th class=\"number\">Lasting</th></tr></thead><tbody>\n";
  for (const calib::PlannedJoint& joint : body.joints) {
    out +=
        "<tr><th>" + joint_name(joint.bone) +
        text_of("</th><td class=\"number\">%.0f %%</td>", 100.0 * joint.measured_share) +
        text_of(
            "<td class=\"number\">%.1f mm</td><td class=\"number\">%.1f mm</td>"
            "<td class=\"number\">%.1f mm</td></tr>\n",
            1e3 * joint.error_m.median,
            1e3 * joint.error_m.p95,
            1e3 * joint.lasting_error_m);
  }
  out += text_of(
      "<tr><th>All</th><td class=\"number\">%.0f %%</td><td "
      "class=\"number\">%.1f mm</td><td class=\"number\">%.1f mm</td><td></td>"
      "</tr>\n",
      100.0 * body.measured_share,
      1e3 * body.error_m.median,
      1e3 * body.error_m.p95);
  out += "</tbody></table></div>\n";
  const double worst_m = worst_stand(report.body);
  out += key("Expected error of a joint, standing there",
             "0",
             text_of("%g mm", 1e3 * worst_m),
             "body not found");
  out += key("Joints whose tags a camera sees", "100 %", "0 %", "body not found");
  return out + "<div class=\"maps\">" +
         floor_map(report,
                   stands_of(report, true, worst_m),
                   report.stand_step_m,
                   "Median error of a joint, the body standing there, one frame alone") +
         floor_map(report,
                   stands_of(report, false, worst_m),
                   report.stand_step_m,
                   "Share of joints that are measured, the body standing there") +
         "</div>\n";
}

std::string tag_words(const PlanReport& report) {
  return text_of(
      "Tags stand upright and face all around, with nothing in the way of a sight. A "
      "joint "
      "is %.0f mm from its tag. Errors are of one tag in one frame.",
      1e3 * report.options.lever_m);
}

std::string lead_of(const PlanReport& report) {
  return text_of("<p class=\"lead\">%.0f cameras, tags of %.0f mm, a body of %.2f m. ",
                 static_cast<double>(report.cameras.size()),
                 1e3 * report.options.tag_size_m,
                 report.stature_m) +
         text_of(
             "A camera sees a tag that lies whole in its picture, turned away by less "
             "than %.0f degrees, with every side of %.0f px or more. ",
             report.options.max_angle_rad * 180.0 / std::numbers::pi,
             report.options.min_side_px) +
         known_words(report) + "</p>\n";
}

}  // namespace

std::string plan_page(const PlanReport& report) {
  const double worst_m = scale_of(report.plan);
  const double max_share = max_covered(report.plan);
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "img-src "
      "data:; style-src 'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>marey plan</title>\n<style>\n";
  out += report_style();
  out += kStyle;
  out += "</style>\n</head>\n<body>\n<main>\n<h1>Plan: " + escaped(report.name) +
         "</h1>\n" + lead_of(report) + body_section(report) +
         "<h2>Single tags</h2>\n<p class=\"about\">" + tag_words(report) + "</p>\n" +
         table_of(report);
  const auto error = [&](const calib::PlannedPlace& place) -> std::optional<double> {
    if (!place.centre_error_m) return std::nullopt;
    return *place.centre_error_m / worst_m;
  };
  const auto coverage = [&](const calib::PlannedPlace& place) -> std::optional<double> {
    if (place.measured_share == 0.0) return std::nullopt;
    return 1.0 - place.measured_share / max_share;
  };
  out +=
      "<h2>Tags, from above</h2>\n<p class=\"about\">Squares of a metre, x to the right, "
      "z "
      "down. Dashed: what each camera's picture takes in. Point at a square for its "
      "figures.</p>\n";
  out += key("Expected error of a tag", "0", text_of("%g mm", 1e3 * worst_m));
  out += key("Directions in which two cameras see it",
             text_of("%.0f %%", 100.0 * max_share),
             "0 %");
  for (std::size_t i = 0; i < report.plan.heights.size(); ++i) {
    out +=
        "<section><h3>At the " + escaped(report.height_names[i]) +
        text_of(", %.2f m</h3>\n<div class=\"maps\">", report.plan.heights[i].height_m) +
        floor_map(report,
                  cells_of(report, i, error),
                  report.grid.step_m,
                  "Expected error of a tag's centre") +
        floor_map(report,
                  cells_of(report, i, coverage),
                  report.grid.step_m,
                  "Share of directions in which two cameras see a tag") +
        "</div></section>\n";
  }
  return out + "</main>\n</body>\n</html>\n";
}

}  // namespace marey::app

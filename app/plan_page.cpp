// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <string_view>

#include <glm/geometric.hpp>

#include "app/plan_figures.h"
#include "app/report_page.h"

namespace marey::app {
namespace {

/// Over that of the report's page (app/report/report.css).
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

std::string text_of(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[400];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

/// `text` where HTML wants words, in an element or an attribute.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Cividis (Nunez, Anderton, Renslow 2018), as the report has it: 0 is dark blue.
std::string colour(double share) {
  constexpr std::array<std::array<double, 3>, 6> kStops{{{0.0, 0.135, 0.305},
                                                         {0.2, 0.27, 0.43},
                                                         {0.42, 0.42, 0.445},
                                                         {0.65, 0.6, 0.47},
                                                         {0.87, 0.78, 0.37},
                                                         {1.0, 0.92, 0.27}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  std::array<double, 3> mixed{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = place - static_cast<double>(i);
    mixed[k] = 255.0 * (kStops[i][k] + part * (kStops[i + 1][k] - kStops[i][k]));
  }
  return text_of("rgb(%.0f %.0f %.0f)", mixed[0], mixed[1], mixed[2]);
}

/// The part of the floor that a page shows: the volume and all cameras.
struct Frame {
  glm::dvec2 least{0.0};
  glm::dvec2 extent{0.0};
};

glm::dvec2 flat(const glm::dvec3& p) {
  return {p.x, p.z};
}

Frame frame_of(const PlanReport& report) {
  glm::dvec2 least = flat(report.grid.least_in_world);
  glm::dvec2 greatest = flat(report.grid.greatest_in_world);
  for (const Camera& camera : report.cameras) {
    const glm::dvec2 place = flat(centre_in_world(camera));
    least = glm::min(least, place);
    greatest = glm::max(greatest, place);
  }
  constexpr double kRim_m = 0.7;
  return {least - kRim_m, greatest - least + 2.0 * kRim_m};
}

/// Where the ray through `pixel` goes on the floor plan; nullopt where there is none.
std::optional<glm::dvec2> heading(const Camera& camera, const glm::dvec2& pixel) {
  const auto ray = unproject(camera.intrinsics, pixel);
  if (!ray) return std::nullopt;
  const RigidTransform world_from_camera = inverse(camera.camera_from_world);
  const glm::dvec2 way =
      flat(world_from_camera.rotation * glm::dvec3(ray->x, ray->y, 1.0));
  const double length = glm::length(way);
  if (!(length > 1e-9)) return std::nullopt;
  return way / length;
}

std::string polygon(const char* name, std::initializer_list<glm::dvec2> corners) {
  std::string out = "<polygon class=\"" + std::string(name) + "\" points=\"";
  for (const glm::dvec2& corner : corners)
    out += text_of("%.3f,%.3f ", corner.x, corner.y);
  return out + "\"/>";
}

std::string cone(const char* name, const Camera& camera, double length_m) {
  const Intrinsics& k = camera.intrinsics;
  const double middle = 0.5 * (k.height_px - 1);
  const auto left = heading(camera, {0.0, middle});
  const auto right = heading(camera, {k.width_px - 1.0, middle});
  if (!left || !right) return "";
  const glm::dvec2 at = flat(centre_in_world(camera));
  return polygon(name, {at, at + length_m * *left, at + length_m * *right});
}

/// A camera as a wedge that opens where it looks, and its name behind it.
std::string body(const Camera& camera, double size_m, const Frame& frame) {
  const Intrinsics& k = camera.intrinsics;
  const auto ahead = heading(camera, k.centre_px);
  const glm::dvec2 at = flat(centre_in_world(camera));
  const glm::dvec2 way = ahead.value_or(glm::dvec2(0.0, 1.0));
  const glm::dvec2 aside{-way.y, way.x};
  std::string out = polygon("body",
                            {at - 0.5 * size_m * way,
                             at + size_m * (0.6 * way + 0.6 * aside),
                             at + size_m * (0.6 * way - 0.6 * aside)});
  glm::dvec2 name = at + glm::dvec2(0.0, (way.y > 0.0 ? -0.9 : 1.6) * size_m);
  // Letters are some 0.55 of their height wide: the name stays inside.
  const double half_m = std::min(
      0.3 * size_m * static_cast<double>(camera.name.size() + 1), 0.5 * frame.extent.x);
  name.x =
      std::clamp(name.x, frame.least.x + half_m, frame.least.x + frame.extent.x - half_m);
  return out +
         text_of(
             "<text x=\"%.3f\" y=\"%.3f\" font-size=\"%.3f\">", name.x, name.y, size_m) +
         escaped(camera.name) + "</text>";
}

/// What a map shows of a place: its share of the scale, nullopt for none, and words.
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

std::string metres(const Frame& frame) {
  const glm::dvec2 end = frame.least + frame.extent;
  std::string out;
  for (double x = std::ceil(frame.least.x); x <= end.x; x += 1.0) {
    out += text_of("<line class=\"metre\" x1=\"%.3f\" x2=\"%.3f\" ", x, x) +
           text_of("y1=\"%.3f\" y2=\"%.3f\"/>", frame.least.y, end.y);
  }
  for (double z = std::ceil(frame.least.y); z <= end.y; z += 1.0) {
    out +=
        text_of("<line class=\"metre\" x1=\"%.3f\" x2=\"%.3f\" ", frame.least.x, end.x) +
        text_of("y1=\"%.3f\" y2=\"%.3f\"/>", z, z);
  }
  return out;
}

std::string map_of(const PlanReport& report,
                   std::size_t height,
                   const std::string& caption,
                   const Shade& shade) {
  const Frame frame = frame_of(report);
  const double size_m = std::max(frame.extent.x, frame.extent.y) / 30.0;
  std::string out =
      "<figure class=\"map\"><svg role=\"img\" aria-label=\"" + escaped(caption) +
      "\" viewBox=\"" + text_of("%.3f %.3f ", frame.least.x, frame.least.y) +
      text_of("%.3f %.3f\">", frame.extent.x, frame.extent.y) + metres(frame);
  const double far_m = 2.0 * glm::length(frame.extent);
  for (const Camera& camera : report.cameras) out += cone("sight", camera, far_m);
  const std::size_t count = report.plan.places.size() / report.plan.heights.size();
  const double step_m = report.grid.step_m;
  for (std::size_t i = height * count; i < (height + 1) * count; ++i) {
    const calib::PlannedPlace& place = report.plan.places[i];
    const auto share = shade(place);
    // A little larger than its place, so that no seams show.
    out += text_of("<rect x=\"%.3f\" y=\"%.3f\" ",
                   place.p_in_world.x - 0.5 * step_m,
                   place.p_in_world.z - 0.5 * step_m) +
           text_of("width=\"%.3f\" height=\"%.3f\" ", 1.02 * step_m, 1.02 * step_m) +
           (share ? "fill=\"" + colour(*share) + "\"" : "class=\"unseen-cell\"") +
           "><title>" + words_of(place) + "</title></rect>";
  }
  for (const Camera& camera : report.cameras) {
    out += cone("cone", camera, far_m);
  }
  for (const Camera& camera : report.cameras) out += body(camera, size_m, frame);
  return out + "</svg><figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

/// A number of one digit that is no smaller: 1, 2, 5, 10, 20...
double round_above(double value) {
  double step = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-6))));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * step >= value) return factor * step;
  }
  return 10.0 * step;
}

/// Error at the top of the scale: hardly a place has more. [m]
double scale_of(const calib::RigPlan& plan) {
  double worst_m = 0.0;
  for (const auto& height : plan.heights) {
    if (height.centre_error_m) worst_m = std::max(worst_m, height.centre_error_m->p95);
  }
  return worst_m > 0.0 ? round_above(worst_m) : 1e-3;
}

/// The top of the scale of directions: two cameras rarely share all.
double most_covered(const calib::RigPlan& plan) {
  double most = 0.1;
  for (const calib::PlannedPlace& place : plan.places) {
    most = std::max(most, place.measured_share);
  }
  return std::ceil(10.0 * most) / 10.0;
}

std::string key(const std::string& what,
                const std::string& low,
                const std::string& high) {
  std::string stops;
  for (int i = 0; i <= 5; ++i) stops += ", " + colour(i / 5.0);
  return "<p class=\"key\"><span>" + what + "</span> <span>" + low +
         "</span> <span class=\"ramp\" style=\"background: linear-gradient(to right" +
         stops + ")\"></span> <span>" + high +
         "</span> <span class=\"swatch\" style=\"background: var(--seen-none)\"></span> "
         "<span>never seen by two</span></p>\n";
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

std::string lead_of(const PlanReport& report) {
  return text_of("<p class=\"lead\">%.0f cameras, tags of %.0f mm, a body of %.2f m. ",
                 static_cast<double>(report.cameras.size()),
                 1e3 * report.options.tag_size_m,
                 report.stature_m) +
         text_of(
             "Tags stand upright and face all around; a camera sees one that lies "
             "whole in its picture, turned away by less than %.0f degrees, with every "
             "side of %.0f px or more. ",
             report.options.widest_rad * 180.0 / std::numbers::pi,
             report.options.least_side_px) +
         text_of(
             "A joint is %.0f mm from its tag. Errors are of one tag in one frame, "
             "from cameras that are known exactly; bodies hide some of their tags, "
             "which is not counted.</p>\n",
             1e3 * report.options.lever_m);
}

}  // namespace

std::string plan_page(const PlanReport& report) {
  const double worst_m = scale_of(report.plan);
  const double most = most_covered(report.plan);
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
         "</h1>\n" + lead_of(report) + table_of(report);
  const auto error = [&](const calib::PlannedPlace& place) -> std::optional<double> {
    if (!place.centre_error_m) return std::nullopt;
    return *place.centre_error_m / worst_m;
  };
  const auto coverage = [&](const calib::PlannedPlace& place) -> std::optional<double> {
    if (place.measured_share == 0.0) return std::nullopt;
    return 1.0 - place.measured_share / most;
  };
  out +=
      "<h2>From above</h2>\n<p class=\"about\">Squares of a metre, x to the right, z "
      "down. Dashed: what each camera's picture takes in. Point at a square for its "
      "figures.</p>\n";
  out += key("Expected error of a tag", "0", text_of("%g mm", 1e3 * worst_m));
  out += key(
      "Directions in which two cameras see it", text_of("%.0f %%", 100.0 * most), "0 %");
  for (std::size_t i = 0; i < report.plan.heights.size(); ++i) {
    out +=
        "<section><h3>At the " + escaped(report.height_names[i]) +
        text_of(", %.2f m</h3>\n<div class=\"maps\">", report.plan.heights[i].height_m) +
        map_of(report, i, "Expected error of a tag's centre", error) +
        map_of(
            report, i, "Share of directions in which two cameras see a tag", coverage) +
        "</div></section>\n";
  }
  return out + "</main>\n</body>\n</html>\n";
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget/retarget_page.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "app/pages/page_text.h"
#include "app/pages/report_page.h"
#include "app/retarget/balance_section.h"
#include "app/retarget/motion_strip.h"
#include "core/base/frame_range.h"

namespace marey::app {
namespace {

/// CSS in addition to that of the report's page (live/viewer/src/styles/report.css).
constexpr std::string_view kStyle = R"(
main { padding-bottom: 2rem; max-width: 84rem; }
main > h2 { margin-top: 2.2rem; }
.bad { color: var(--poor); font-weight: 600; }
.strips { overflow-x: auto; }
.strips figure { min-width: 46rem; margin: 0 0 1.1rem; }
.strips figcaption { padding: 0 0 0.25rem; }
.strips strong { color: var(--ink); }
.strip { display: block; width: 100%; background: var(--card); border: 1px solid var(--rule); border-radius: 10px; }
.strip path { fill: none; stroke-linecap: round; }
.strip .edge { stroke: var(--card); }
.strip .trunk { stroke: #8b8f96; }
.strip .left { stroke: #2f86c4; }
.strip .right { stroke: #c8553d; }
.strip .grid { stroke: var(--rule); stroke-width: 0.006; }
.strip .ground { stroke: var(--quiet); stroke-width: 0.008; }
.strip .print { stroke-width: 0.05; stroke-opacity: 0.3; }
.strip .bears { fill: #1a9b62; stroke: var(--card); stroke-width: 0.008; }
.moments { display: flex; color: var(--quiet); font-size: 0.82rem; min-width: 46rem; }
.moments span { flex: 1; text-align: center; }
.contacts { display: grid; grid-template-columns: minmax(7rem, 13rem) 1fr; gap: 0.5rem 0.8rem; align-items: center; font-size: 0.88rem; }
.contacts svg { display: block; width: 100%; height: 3.4rem; background: var(--card); border: 1px solid var(--rule); border-radius: 6px; }
.contacts .name { overflow-wrap: anywhere; }
.contacts .rows { display: block; color: var(--quiet); font-size: 0.78rem; }
.contacts rect { shape-rendering: crispEdges; }
.contacts .left { fill: #2f86c4; } .contacts .right { fill: #c8553d; }
.contacts .ball { fill-opacity: 0.55; }
.contacts .moment { stroke: var(--quiet); stroke-width: 1px; stroke-dasharray: 3 3; vector-effect: non-scaling-stroke; }
.contacts .ticks { display: flex; justify-content: space-between; color: var(--quiet); font-size: 0.78rem; }
.key { color: var(--quiet); font-size: 0.85rem; }
.key i { display: inline-block; width: 0.9em; height: 0.7em; border-radius: 2px; margin: 0 0.3em 0 0.9em; }
.bars { display: block; width: 100%; height: 4.2rem; background: var(--card); border: 1px solid var(--rule); border-radius: 6px; }
.bars .left { fill: #2f86c4; } .bars .right { fill: #c8553d; }
)";

/// Limits; figures above them are marked.
constexpr double kMaxSlide_cm_per_s = 0.3;
constexpr double kMaxDrift_mm = 1.0;
constexpr double kMaxSinking_mm = 1.0;
constexpr double kMaxFloat_mm = 5.0;
constexpr double kMaxJerk = 1.1;
constexpr int kMoments = 8;

std::string name_of(const std::filesystem::path& file) {
  return escaped(file.filename().string());
}

std::string cell(const char* format, double value, double limit) {
  // The rounded value is compared: 1.0004 is printed as 1.00.
  return std::string("<td class=\"number") + (value > 1.0005 * limit ? " bad" : "") +
         "\">" + text_of(format, value) + "</td>";
}

double seconds(const RetargetRun& run) {
  return static_cast<double>(run.source.poses.size()) / run.source.rate.hz;
}

std::string errors_of(const RetargetRun& run) {
  std::string items;
  for (const AvatarResult& avatar : run.avatars) {
    if (avatar.error) items += "<li>" + escaped(avatar.error->message()) + "</li>";
  }
  if (items.empty()) return "";
  return "<div class=\"warnings\"><h2>Without result</h2><ul>" + items + "</ul></div>\n";
}

std::string files_of(const AvatarResult& avatar) {
  std::string out;
  for (const auto& file : avatar.files) {
    if (!out.empty()) out += ' ';
    out += "<a href=\"";
    out += name_of(file);
    out += "\">";
    out += escaped(file.extension().string());
    out += "</a>";
  }
  return out;
}

std::string row_of(const AvatarResult& avatar) {
  const retarget::ContactFigures& c = avatar.contacts;
  return "<tr><th>" + escaped(avatar.name) + "</th>" +
         text_of("<td class=\"number\">%.2f m</td>",
                 retarget::head_height_m(avatar.retargeted.motion.skeleton, avatar.map)) +
         cell("%.2f cm/s", c.mean_slide_cm_per_s, kMaxSlide_cm_per_s) +
         text_of("<td class=\"number\">%.2f cm/s</td>",
                 avatar.retargeted.report.before.mean_slide_cm_per_s) +
         text_of("<td class=\"number\">%.2f mm</td>", c.median_drift_mm) +
         cell("%.2f mm", c.worst_drift_mm, kMaxDrift_mm) +
         cell("%.2f mm", c.sinking_mm, kMaxSinking_mm) +
         cell("%.1f mm", c.float_mm, kMaxFloat_mm) +
         cell("%.2f", avatar.jerk_ratio, kMaxJerk) + "<td class=\"files\">" +
         files_of(avatar) + "</td></tr>\n";
}

std::string figures_of(const RetargetRun& run) {
  const retarget::ContactFigures& s = run.figures;
  std::string out =
      "<h2>Feet and the floor</h2>\n<p class=\"about\">Measured while the source's own "
      "ankles and toe joints are slow and low. Red: more than " +
      text_of("%.1f cm/s of slide, %.0f mm of drift or sinking, ",
              kMaxSlide_cm_per_s,
              kMaxDrift_mm) +
      text_of(
          "%.0f mm of float, or %.1f times the jerk of the source at that height.</p>\n",
          kMaxFloat_mm,
          kMaxJerk) +
      "<div class=\"scroll\"><table><thead><tr><th>Body</th><th class=\"number\">Head "
      "joint at</th><th class=\"number\">Slide</th><th class=\"number\">before the "
      "ground</th><th class=\"number\">Drift of a contact, median</th><th "
      "class=\"number\">worst</th><th class=\"number\">Sinking</th><th class=\"number\">"
      "Float</th><th class=\"number\">Jerk</th><th>Files</th></tr></thead><tbody>\n";
  out += "<tr><th>source</th>" +
         text_of("<td class=\"number\">%.2f m</td>",
                 retarget::head_height_m(run.source.skeleton, run.map)) +
         text_of("<td class=\"number\">%.2f cm/s</td><td></td>", s.mean_slide_cm_per_s) +
         text_of("<td class=\"number\">%.2f mm</td><td class=\"number\">%.2f mm</td>",
                 s.median_drift_mm,
                 s.worst_drift_mm) +
         text_of("<td class=\"number\">%.2f mm</td><td class=\"number\">%.1f mm</td>",
                 s.sinking_mm,
                 s.float_mm) +
         "<td class=\"number\">1</td><td></td></tr>\n";
  for (const AvatarResult& avatar : run.avatars) {
    if (!avatar.error) out += row_of(avatar);
  }
  return out + "</tbody></table></div>\n";
}

std::string bars_of(const std::vector<FrameRange>& runs,
                    const char* side,
                    const char* part,
                    int row,
                    double hz) {
  std::string out;
  for (const FrameRange& run : runs) {
    out +=
        text_of("<rect x=\"%.0f\" width=\"%.0f\"", run.first, run.last - run.first + 1) +
        text_of(" y=\"%.1f\" height=\"8\"", 2.0 + 10.0 * row) + " class=\"" + side + " " +
        part + "\"><title>" + side + " " + part +
        text_of(", %.2f to %.2f s", run.first / hz, run.last / hz) + "</title></rect>";
  }
  return out;
}

/// Returns a chart of the contacts of each foot's heel and ball: four rows.
std::string contacts_of(const Contacts& contacts,
                        const std::vector<int>& moments,
                        double hz) {
  std::string out = text_of("<svg viewBox=\"0 0 %.0f 42\" preserveAspectRatio=\"none\">",
                            contacts.frame_count);
  constexpr std::array<const char*, 2> kSides{"left", "right"};
  for (std::size_t side = 0; side < 2; ++side) {
    const int row = 2 * static_cast<int>(side);
    out += bars_of(contacts.feet[side].heel, kSides[side], "heel", row, hz);
    out += bars_of(contacts.feet[side].ball, kSides[side], "ball", row + 1, hz);
  }
  for (const int frame : moments) {
    out += text_of("<line class=\"moment\" x1=\"%.1f\" x2=\"%.1f\" y1=\"0\" y2=\"42\"/>",
                   frame + 0.5,
                   frame + 0.5);
  }
  return out + "</svg>";
}

std::string timeline_of(const RetargetRun& run, const std::vector<int>& moments) {
  const double hz = run.source.rate.hz;
  std::string out =
      "<h2>When feet stand</h2>\n<p class=\"key\">Rows from above: left heel, left ball, "
      "right heel, right ball.<i style=\"background:#2f86c4\"></i>left<i "
      "style=\"background:#c8553d\"></i>right, paler: the ball. Dashed: the moments of "
      "the "
      "pictures. In the source as found, on avatars as found again in the result.</p>\n"
      "<div class=\"contacts\">";
  const auto add = [&](const std::string& name, const Contacts& contacts) {
    out += "<div class=\"name\">" + name + "</div>" + contacts_of(contacts, moments, hz);
  };
  add("source", run.contacts);
  for (const AvatarResult& avatar : run.avatars) {
    if (!avatar.error) add(escaped(avatar.name), avatar.own_contacts);
  }
  out += "<div></div><div class=\"ticks\">";
  for (int i = 0; i <= 4; ++i) {
    out += text_of("<span>%.1f s</span>", 0.25 * i * seconds(run));
  }
  return out + "</div></div>\n";
}

std::string strips_of(const RetargetRun& run, const std::vector<int>& moments) {
  const StripView view = view_of(run.source, run.map);
  std::string out =
      "<h2>At the same moments</h2>\n<p class=\"key\">Every body drawn as tall as the "
      "others, from its front and left.<i style=\"background:#2f86c4\"></i>left<i "
      "style=\"background:#c8553d\"></i>right<i style=\"background:#1a9b62\"></i>bears "
      "there. Pale on the floor: footprints of all stances; lines of the floor are half "
      "a "
      "body apart and stay where they are.</p>\n<div class=\"strips\"><div "
      "class=\"moments\">";
  for (const int frame : moments) {
    out += text_of("<span>%.2f s</span>", frame / run.source.rate.hz);
  }
  out += "</div>";
  const auto add = [&](const std::string& name,
                       const Motion& motion,
                       const retarget::BodyMap& map,
                       const Contacts& contacts) {
    out += "<figure><figcaption><strong>" + name + "</strong>" +
           text_of(", head joint at %.2f m</figcaption>",
                   retarget::head_height_m(motion.skeleton, map)) +
           motion_strip(motion, map, contacts, moments, view) + "</figure>\n";
  };
  add("source", run.source, run.map, run.contacts);
  for (const AvatarResult& avatar : run.avatars) {
    if (avatar.error) continue;
    add(escaped(avatar.name), avatar.retargeted.motion, avatar.map, avatar.own_contacts);
  }
  return out + "</div>\n";
}

/// Returns the drift of every contact of one body, as bars over time.
std::string drifts_of(const AvatarResult& avatar, double hz) {
  const auto& drifts = avatar.contacts.drifts;
  const double scale_mm = std::max(kMaxDrift_mm, avatar.contacts.worst_drift_mm);
  std::string out =
      "<figure><svg class=\"bars\" preserveAspectRatio=\"none\" viewBox=\"0 0 " +
      text_of("%.0f 40\">", static_cast<double>(avatar.retargeted.motion.poses.size()));
  for (const retarget::ContactDrift& drift : drifts) {
    const double high = std::max(0.6, 38.0 * drift.drift_mm / scale_mm);
    const auto point = static_cast<std::size_t>(drift.point);
    out += text_of("<rect x=\"%.0f\" width=\"%.0f\"",
                   drift.frames.first,
                   drift.frames.last - drift.frames.first + 1) +
           text_of(" y=\"%.2f\" height=\"%.2f\"", 40.0 - high, high) +
           (drift.point % 2 == 0 ? " class=\"left\"" : " class=\"right\"") +
           " fill-opacity=\"0.6\"><title>" +
           std::string(name(retarget::kContactBones[point])) +
           text_of(", %.2f to %.2f s: %.3f mm</title></rect>",
                   drift.frames.first / hz,
                   drift.frames.last / hz,
                   drift.drift_mm);
  }
  return out + "</svg><figcaption>" + escaped(avatar.name) +
         text_of(": %.0f contacts, top of the scale %.2g mm</figcaption></figure>\n",
                 static_cast<double>(drifts.size()),
                 scale_mm);
}

std::string drift_section(const RetargetRun& run) {
  std::string out =
      "<h2>Drift of each contact</h2>\n<p class=\"about\">Largest distance of an "
      "ankle or a toe joint from the place where its contact began, over time. Point at "
      "a bar for its figures.</p>\n";
  for (const AvatarResult& avatar : run.avatars) {
    if (!avatar.error) out += drifts_of(avatar, run.source.rate.hz);
  }
  return out;
}

}  // namespace

std::string retarget_page(const RetargetRun& run) {
  const auto frames = static_cast<int>(run.source.poses.size());
  const std::vector<int> moments = strip_frames(frames, kMoments);
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "img-src data:; style-src 'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>marey retarget</title>\n<style>\n";
  out += report_style();
  out += kStyle;
  out += kBalanceStyle;
  out += "</style>\n</head>\n<body>\n<main>\n<h1>" + name_of(run.motion) + "</h1>\n" +
         text_of("<p class=\"lead\">%.0f frames at %.6g Hz, %.2f s",
                 frames,
                 run.source.rate.hz,
                 seconds(run)) +
         (run.live ? ", retargeted frame by frame, without future frames"
                   : ", retargeted as a whole") +
         ".</p>\n" + errors_of(run) + figures_of(run) + strips_of(run, moments) +
         timeline_of(run, moments) + balance_section(run, moments) + drift_section(run);
  return out + "</main>\n</body>\n</html>\n";
}

}  // namespace marey::app

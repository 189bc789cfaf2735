// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget/balance_section.h"

#include "app/pages/page_text.h"

namespace marey::app {
namespace {

std::string frames_cell(int frames) {
  return text_of("<td class=\"number\">%.0f</td>", frames);
}

std::string share_cell(const retarget::BalanceFigures& figures) {
  return text_of("<td class=\"number\">%.1f %%</td>", 100.0 * figures.over_share());
}

/// Returns the cells on the zero moment points; empty cells without a supported frame.
std::string zmp_cells(const dynamics::ZmpFigures& figures) {
  if (figures.supported_frames == 0) return "<td></td><td></td>";
  return text_of("<td class=\"number\">%.1f %%</td>", 100.0 * figures.inside_share()) +
         text_of("<td class=\"number\">%.0f mm</td>", 1e3 * figures.worst_outside_m);
}

std::string row_of(const RetargetRun& run, const AvatarResult& avatar) {
  const auto made = retarget::balance_measures(avatar.balance, run.balance);
  std::string out = "<tr><th>" + escaped(avatar.name) + "</th>" + share_cell(made) +
                    frames_cell(made.lost_frames) + zmp_cells(avatar.zmp);
  const auto& report = avatar.retargeted.report.balance;
  if (!report) return out + "<td></td><td></td><td></td><td></td><td></td></tr>\n";
  return out + share_cell(report->before) + frames_cell(report->before.lost_frames) +
         text_of("<td class=\"number\">%.1f mm</td>", 1e3 * report->kept.mean_off_m) +
         text_of("<td class=\"number\">%.1f mm</td>",
                 1e3 * report->kept.mean_off_before_m) +
         text_of("<td class=\"number\">%.0f mm</td>", 1e3 * report->kept.max_shift_m) +
         "</tr>\n";
}

/// Returns bars for runs of frames of one state: above the support, or off it.
std::string bars_of(const retarget::BalanceTrack& track,
                    const std::vector<int>& moments,
                    double hz) {
  const auto kind = [&](std::size_t t) {
    return !track[t] ? 0 : *track[t] <= 0.0 ? 1 : 2;
  };
  std::string out = text_of("<svg viewBox=\"0 0 %.0f 42\" preserveAspectRatio=\"none\">",
                            static_cast<double>(track.size()));
  for (std::size_t first = 0; first < track.size();) {
    std::size_t end = first + 1;
    while (end < track.size() && kind(end) == kind(first)) ++end;
    if (kind(first) != 0) {
      const bool over = kind(first) == 1;
      out +=
          text_of("<rect y=\"6\" height=\"30\" x=\"%.0f\" width=\"%.0f\"",
                  static_cast<double>(first),
                  static_cast<double>(end - first)) +
          (over ? " class=\"over\"><title>inside" : " class=\"outside\"><title>outside") +
          text_of(" the support area, %.2f to %.2f s</title></rect>",
                  static_cast<double>(first) / hz,
                  static_cast<double>(end - 1) / hz);
    }
    first = end;
  }
  for (const int frame : moments) {
    out += text_of("<line class=\"moment\" x1=\"%.1f\" x2=\"%.1f\" y1=\"0\" y2=\"42\"/>",
                   frame + 0.5,
                   frame + 0.5);
  }
  return out + "</svg>";
}

}  // namespace

const std::string_view kBalanceStyle = R"(
.contacts .who { overflow-wrap: anywhere; }
.contacts .over { fill: #1a9b62; } .contacts .outside { fill: #d9a441; }
)";

std::string balance_section(const RetargetRun& run, const std::vector<int>& moments) {
  const auto source = retarget::balance_measures(run.balance);
  std::string out =
      "<h2>Centre of mass and the feet</h2>\n<p class=\"about\">Share of the frames with "
      "a bearing foot in which the centre of mass (average shares of mass) is above the "
      "support; in dynamic motions it is mostly outside. Lost: frames in which the "
      "source is above its support and the body is not. Off: distance from the source's "
      "place in the support. Without: before the root is moved for balance, and before "
      "hands; empty without --balance. Zero moment point: share of the frames with a "
      "bearing foot in which it is inside the support, and its largest distance outside; "
      "it includes the accelerations of the motion."
      "</p>\n<div class=\"scroll\"><table><thead><tr><th>Body</th><th "
      "class=\"number\">Over its support</th><th class=\"number\">Frames lost</th><th "
      "class=\"number\">Zero moment point "
      "inside</th><th class=\"number\">outside by up to</th><th "
      "class=\"number\">Without: over</th><th class=\"number\">lost</th><th "
      "class=\"number\">Off</th><th class=\"number\">without</th><th "
      "class=\"number\">Root moved by up "
      "to</th></tr></thead><tbody>\n<tr><th>source</th>";
  out +=
      share_cell(source) +
      "<td></td><td></td><td></td><td></td><td></td><td></td><td></td><td></td></tr>\n";
  for (const AvatarResult& avatar : run.avatars) {
    if (!avatar.error) out += row_of(run, avatar);
  }
  out +=
      "</tbody></table></div>\n<p class=\"key\"><i style=\"background:#1a9b62\"></i>over "
      "its support<i style=\"background:#d9a441\"></i>outside; nothing: no foot bears. "
      "Dashed: the moments of the pictures.</p>\n<div class=\"contacts\">";
  const auto add = [&](const std::string& name, const retarget::BalanceTrack& track) {
    out += "<div class=\"who\">" + name + "</div>" +
           bars_of(track, moments, run.source.rate.hz);
  };
  add("source", run.balance);
  for (const AvatarResult& avatar : run.avatars) {
    if (!avatar.error) add(escaped(avatar.name), avatar.balance);
  }
  return out + "</div>\n";
}

}  // namespace marey::app

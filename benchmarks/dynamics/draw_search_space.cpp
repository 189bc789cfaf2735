// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// draw_search_space docs/figures/search_space.svg
//
// Draws the search space of the thesis' law (figure 6.10) for a push from rest to a
// take-off of 2.43 m/s in 0.7 s, coloured by the rule that binds, with three lowest
// points in it, and their heights and pushes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/push/thesis_push.h"

namespace marey::dynamics {
namespace {

constexpr int kWidth = 880;
constexpr int kHeight = 492;

/// A rectangle of the picture with its axes. y grows downwards in the picture.
struct Panel {
  double left, top, width, height;
  double x_from, x_to, y_from, y_to;

  [[nodiscard]] double x(double value) const {
    return left + width * (value - x_from) / (x_to - x_from);
  }
  [[nodiscard]] double y(double value) const {
    return top + height * (y_to - value) / (y_to - y_from);
  }
};

const Panel kSpacePanel{70.0, 76.0, 380.0, 356.0, 0.4, 0.82, -420.0, -90.0};
const Panel kHeightPanel{540.0, 76.0, 310.0, 166.0, 0.0, 0.7, -360.0, 100.0};
const Panel kPushPanel{540.0, 286.0, 310.0, 146.0, 0.0, 0.7, -0.5, 3.5};

/// A rule in words, and the colours of its area and its line.
struct RuleColour {
  const char* words;
  const char* area;
  const char* line;
};
const std::array<RuleColour, 3> kRules{
    {{"the push would be negative", "#cfe1f2", "#1f6fb0"},
     {"the body would rise before P2", "#fbe3bb", "#c47f00"},
     {"the body would sink after P2", "#d6ecd0", "#3f8f34"}}};
constexpr const char* kNoHeight = "#e4e4e4";

/// A lowest point. B is on the border where the push touches 0.
struct Choice {
  const char* name;
  double at;
  double lowest_m;
  const char* colour;
  double name_below;  ///< Place of its name under its dot, in the picture.
};
const std::array<Choice, 3> kChoices{{{"A", 0.50, -0.165, "#b3263a", 19.0},
                                      {"B", 0.59, -0.3275, "#222222", -10.0},
                                      {"C", 0.73, -0.150, "#7a3fa6", -10.0}}};

std::string printed(const char* format, double a, double b = 0.0) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

class Picture {
 public:
  void text(double x, double y, const std::string& words, const std::string& more = "") {
    body_ += "<text " + printed("x=\"%.1f\" y=\"%.1f\"", x, y) + more + ">" + words +
             "</text>\n";
  }
  void line(double x1, double y1, double x2, double y2, const std::string& more) {
    body_ += "<path d=\"" + printed("M%.1f %.1f", x1, y1) +
             printed("L%.1f %.1f", x2, y2) + "\" " + more + "/>\n";
  }
  void shape(const std::vector<std::pair<double, double>>& points,
             const std::string& more) {
    if (points.empty()) return;
    body_ += "<path d=\"M";
    for (const auto& [x, y] : points) {
      if (body_.back() != 'M') body_ += 'L';
      body_ += printed("%.1f %.1f", x, y);
    }
    body_ += "\" " + more + "/>\n";
  }
  void box(double x, double y, double width, double height, const std::string& more) {
    body_ += "<rect " + printed("x=\"%.1f\" y=\"%.1f\"", x, y) +
             printed(" width=\"%.1f\" height=\"%.1f\" ", width, height) + more + "/>\n";
  }
  void dot(double x, double y, const std::string& colour) {
    body_ += "<circle " + printed("cx=\"%.1f\" cy=\"%.1f\"", x, y) + " r=\"5\" fill=\"" +
             colour + "\" stroke=\"#ffffff\" stroke-width=\"1.5\"/>\n";
  }
  [[nodiscard]] std::string svg() const {
    const std::string size =
        std::to_string(kWidth) + "\" height=\"" + std::to_string(kHeight);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
           std::to_string(kWidth) + " " + std::to_string(kHeight) + "\" width=\"" + size +
           "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" +
           body_ + "</svg>\n";
  }

 private:
  std::string body_;
};

/// Draws ticks with their numbers along both axes, and a frame.
void draw_axes(Picture& picture,
               const Panel& panel,
               const std::vector<double>& x_ticks,
               const std::vector<double>& y_ticks) {
  const double bottom = panel.top + panel.height;
  for (const double x : x_ticks) {
    picture.line(panel.x(x), bottom, panel.x(x), bottom + 4.0, "stroke=\"#222222\"");
    picture.text(panel.x(x), bottom + 17.0, printed("%g", x), " text-anchor=\"middle\"");
  }
  for (const double y : y_ticks) {
    picture.line(
        panel.left - 4.0, panel.y(y), panel.left, panel.y(y), "stroke=\"#222222\"");
    const std::string minus = y < 0.0 ? "&#8722;" : "";
    picture.text(panel.left - 8.0,
                 panel.y(y) + 4.0,
                 minus + printed("%g", std::abs(y)),
                 " text-anchor=\"end\"");
  }
  picture.box(panel.left,
              panel.top,
              panel.width,
              panel.height,
              "fill=\"none\" stroke=\"#222222\"");
}

/// One column of the search space, in places of the picture.
struct PictureColumn {
  double x = 0.0;
  double low = 0.0;
  double high = 0.0;
  std::size_t low_rule = 0;
  std::size_t high_rule = 0;
};

std::vector<PictureColumn> columns_of(const PushEnds& ends) {
  constexpr int kColumns = 700;
  std::vector<PictureColumn> columns;
  for (const SpaceColumn& c : search_space(ends, kColumns)) {
    const HeightBound& low = c.heights.low;
    const HeightBound& high = c.heights.high;
    columns.push_back({kSpacePanel.x(c.lowest_at),
                       kSpacePanel.y(1e3 * low.height_m),
                       kSpacePanel.y(1e3 * high.height_m),
                       static_cast<std::size_t>(low.rule),
                       static_cast<std::size_t>(high.rule)});
  }
  return columns;
}

/// Calls `draw(first, last)` for each run of columns with one rule; runs share a column.
template <class RuleOf, class Draw>
void for_runs(const std::vector<PictureColumn>& columns, RuleOf rule_of, Draw draw) {
  std::size_t first = 0;
  for (std::size_t k = 1; k <= columns.size(); ++k) {
    if (k < columns.size() && rule_of(columns[k]) == rule_of(columns[first])) continue;
    draw(first, std::min(k, columns.size() - 1));
    first = k;
  }
}

/// Fills the area above (below) the heights that the rules leave, by the rule that binds.
void fill_outside(Picture& picture,
                  const std::vector<PictureColumn>& columns,
                  bool is_above) {
  const double edge = is_above ? kSpacePanel.top : kSpacePanel.top + kSpacePanel.height;
  const auto rule_of = [&](const PictureColumn& c) {
    return is_above ? c.high_rule : c.low_rule;
  };
  for_runs(columns, rule_of, [&](std::size_t first, std::size_t last) {
    std::vector<std::pair<double, double>> points{{columns[first].x, edge}};
    for (std::size_t k = first; k <= last; ++k) {
      const PictureColumn& c = columns[k];
      points.emplace_back(c.x, is_above ? c.high : c.low);
    }
    points.emplace_back(columns[last].x, edge);
    picture.shape(points,
                  std::string("fill=\"") + kRules[rule_of(columns[first])].area + "\"");
  });
}

void draw_space(Picture& picture, const PushEnds& ends) {
  const Panel& panel = kSpacePanel;
  const auto columns = columns_of(ends);
  picture.box(panel.left,
              panel.top,
              panel.width,
              panel.height,
              std::string("fill=\"") + kNoHeight + "\"");
  fill_outside(picture, columns, true);
  fill_outside(picture, columns, false);
  // The space itself.
  std::vector<std::pair<double, double>> outline;
  for (const PictureColumn& c : columns) outline.emplace_back(c.x, c.high);
  for (std::size_t k = columns.size(); k-- > 0;)
    outline.emplace_back(columns[k].x, columns[k].low);
  picture.shape(outline, "fill=\"#ffffff\"");
  for (const bool is_high : {true, false}) {
    const auto rule_of = [&](const PictureColumn& c) {
      return is_high ? c.high_rule : c.low_rule;
    };
    for_runs(columns, rule_of, [&](std::size_t first, std::size_t last) {
      std::vector<std::pair<double, double>> points;
      for (std::size_t k = first; k <= last; ++k)
        points.emplace_back(columns[k].x, is_high ? columns[k].high : columns[k].low);
      picture.shape(points,
                    std::string("fill=\"none\" stroke-width=\"2.5\" "
                                "stroke-linejoin=\"round\" stroke=\"") +
                        kRules[rule_of(columns[first])].line + "\"");
    });
  }
  for (const Choice& choice : kChoices) {
    const double x = panel.x(choice.at);
    const double y = panel.y(1e3 * choice.lowest_m);
    picture.dot(x, y, choice.colour);
    picture.text(x + 9.0,
                 y + 4.0,
                 choice.name,
                 std::string(" font-weight=\"bold\" fill=\"") + choice.colour + "\"");
  }
  draw_axes(picture,
            panel,
            {0.4, 0.5, 0.6, 0.7, 0.8},
            {-400, -350, -300, -250, -200, -150, -100});
}

void draw_curves(Picture& picture, const PushEnds& ends) {
  constexpr int kSteps = 70;
  picture.box(kPushPanel.left,
              kPushPanel.y(0.0),
              kPushPanel.width,
              kPushPanel.top + kPushPanel.height - kPushPanel.y(0.0),
              std::string("fill=\"") + kRules[0].area + "\"");
  picture.line(kHeightPanel.left,
               kHeightPanel.y(0.0),
               kHeightPanel.left + kHeightPanel.width,
               kHeightPanel.y(0.0),
               "stroke=\"#bbbbbb\"");
  picture.line(kPushPanel.left,
               kPushPanel.y(1.0),
               kPushPanel.left + kPushPanel.width,
               kPushPanel.y(1.0),
               "stroke=\"#bbbbbb\"");
  for (const Choice& choice : kChoices) {
    const auto push = thesis_push(ends, choice.at, choice.lowest_m);
    if (!push) continue;
    std::vector<std::pair<double, double>> height;
    std::vector<std::pair<double, double>> force;
    for (int k = 0; k <= kSteps; ++k) {
      const double t_s = ends.duration_s * k / kSteps;
      height.emplace_back(kHeightPanel.x(t_s), kHeightPanel.y(1e3 * push->height_m(t_s)));
      force.emplace_back(kPushPanel.x(t_s),
                         kPushPanel.y(push->force_m_s2(t_s) / kStandardGravity_m_s2));
    }
    const std::string stroke =
        std::string("fill=\"none\" stroke-width=\"2\" stroke=\"") + choice.colour + "\"";
    picture.shape(height, stroke);
    picture.shape(force, stroke);
    const double lowest_s = choice.at * ends.duration_s;
    picture.dot(
        kHeightPanel.x(lowest_s), kHeightPanel.y(1e3 * choice.lowest_m), choice.colour);
    picture.text(kHeightPanel.x(lowest_s),
                 kHeightPanel.y(1e3 * choice.lowest_m) + choice.name_below,
                 choice.name,
                 std::string(" text-anchor=\"middle\" font-weight=\"bold\" fill=\"") +
                     choice.colour + "\"");
  }
  picture.text(kHeightPanel.x(0.008), kHeightPanel.y(22.0), "P1");
  picture.text(
      kHeightPanel.x(0.7) - 8.0, kHeightPanel.y(66.0), "P3", " text-anchor=\"end\"");
  draw_axes(picture, kHeightPanel, {}, {-300, -200, -100, 0, 100});
  draw_axes(picture, kPushPanel, {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}, {0, 1, 2, 3});
}

void draw_words(Picture& picture) {
  double x = kSpacePanel.left;
  for (const RuleColour& rule : kRules) {
    picture.box(x,
                13.0,
                12.0,
                12.0,
                std::string("fill=\"") + rule.area + "\" stroke=\"" + rule.line + "\"");
    picture.text(x + 18.0, 23.5, rule.words);
    x += 46.0 + 6.3 * static_cast<double>(std::string(rule.words).size());
  }
  picture.box(
      x, 13.0, 12.0, 12.0, std::string("fill=\"") + kNoHeight + "\" stroke=\"#888888\"");
  picture.text(x + 18.0, 23.5, "no P2 at this time");
  picture.text(kSpacePanel.left, 62.0, "Search space of the lowest point P2");
  picture.text(
      kHeightPanel.left, 62.0, "Height of the centre of mass over its start, mm");
  picture.text(kPushPanel.left, 276.0, "Push over the weight");
  picture.text(kSpacePanel.left + 0.5 * kSpacePanel.width,
               kHeight - 20.0,
               "time of P2, as a share of the push",
               " text-anchor=\"middle\"");
  picture.text(kPushPanel.left + 0.5 * kPushPanel.width,
               kHeight - 20.0,
               "time, s",
               " text-anchor=\"middle\"");
  const double y = kSpacePanel.top + 0.5 * kSpacePanel.height;
  picture.text(
      18.0,
      y,
      "height of P2 over the start, mm",
      printed(" text-anchor=\"middle\" transform=\"rotate(-90 %.0f %.0f)\"", 18.0, y));
}

std::string search_space_picture() {
  PushEnds ends;
  ends.end_m = 0.08;
  ends.end_m_s = 2.43;
  ends.duration_s = 0.7;
  Picture picture;
  draw_space(picture, ends);
  draw_curves(picture, ends);
  draw_words(picture);
  return picture.svg();
}

}  // namespace
}  // namespace marey::dynamics

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: draw_search_space OUT.svg\n");
    return 2;
  }
  std::ofstream out(argv[1]);
  out << marey::dynamics::search_space_picture();
  out.close();
  if (!out) {
    std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
    return 3;
  }
  return 0;
}

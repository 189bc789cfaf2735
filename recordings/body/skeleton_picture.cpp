// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/skeleton_picture.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include <cairo-svg.h>
#include <cairo.h>
#include <glm/vec2.hpp>

#include "core/base/extension.h"
#include "core/base/in_quotes.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/text_reader.h"

namespace marey::recordings {
namespace {

// Pixels, or points of an SVG.
constexpr double kWidth = 1600.0;
constexpr double kPictureHeight = 1000.0;
constexpr double kMargin = 60.0;
constexpr double kLetters = 15.0;

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using Pen = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

cairo_status_t append_bytes(void* text, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

struct Colour {
  double red, green, blue;
};

Colour colour_of(const Joint& joint) {
  if (!joint.bone) return {0.6, 0.6, 0.6};
  const HumanBone other = mirrored(*joint.bone);
  if (other == *joint.bone) return {0.15, 0.15, 0.15};
  return index(*joint.bone) < index(other) ? Colour{0.1, 0.35, 0.75}
                                           : Colour{0.75, 0.2, 0.1};
}

void choose(cairo_t* pen, const Colour& colour) {
  cairo_set_source_rgb(pen, colour.red, colour.green, colour.blue);
}

/// One of the two pictures: horizontal and vertical page axes, in metres from a centre.
struct View {
  bool is_front = true;
  glm::dvec2 middle_m{0.0};
  double across_middle = 0.0;  ///< On the page.
  double per_metre = 1.0;
  double to_names = 0.0;  ///< From the centre.

  [[nodiscard]] glm::dvec2 seen(const glm::dvec3& p) const {
    return {is_front ? p.x : -p.z, p.y};
  }
  [[nodiscard]] glm::dvec2 on_page(const glm::dvec3& p) const {
    const glm::dvec2 off = (seen(p) - middle_m) * per_metre;
    return {across_middle + off.x, 0.5 * kPictureHeight - off.y};
  }
};

struct Drawing {
  const Skeleton& skeleton;
  std::vector<RigidTransform> world;
  glm::dvec3 low{1e9};
  glm::dvec3 high{-1e9};
};

Drawing drawing_of(const Skeleton& skeleton) {
  Drawing drawing{skeleton, world_from_joints(skeleton, rest_pose(skeleton))};
  for (std::size_t i = 0; i < drawing.world.size(); ++i) {
    glm::dvec3 end = drawing.world[i].translation;
    for (int pass = 0; pass < 2; ++pass) {
      drawing.low = glm::min(drawing.low, end);
      drawing.high = glm::max(drawing.high, end);
      const auto& tip = skeleton.joints[i].tip_in_joint;
      if (tip) end = drawing.world[i] * *tip;
    }
  }
  return drawing;
}

void line(cairo_t* pen, const glm::dvec2& from, const glm::dvec2& to, double width) {
  cairo_set_line_width(pen, width);
  cairo_move_to(pen, from.x, from.y);
  cairo_line_to(pen, to.x, to.y);
  cairo_stroke(pen);
}

void draw_bones(cairo_t* pen, const Drawing& drawing, const View& view) {
  const auto& joints = drawing.skeleton.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const glm::dvec2 here = view.on_page(drawing.world[i].translation);
    if (joint.parent) {
      const std::size_t parent = index(*joint.parent);
      choose(pen, colour_of(joints[parent].bone ? joints[parent] : joint));
      line(pen,
           view.on_page(drawing.world[parent].translation),
           here,
           joint.bone ? 2.5 : 1.0);
    }
    choose(pen, colour_of(joint));
    if (joint.tip_in_joint) {
      line(pen, here, view.on_page(drawing.world[i] * *joint.tip_in_joint), 1.0);
    }
    cairo_arc(pen, here.x, here.y, joint.bone ? 4.5 : 2.0, 0.0, 6.2832);
    cairo_fill(pen);
  }
}

/// Draws names in a column next to the figure, in the order of their heights, so that
/// they do not overlap.
void draw_names(cairo_t* pen, const Drawing& drawing, const View& view, bool right) {
  struct Label {
    glm::dvec2 at;
    const Joint* joint;
  };
  std::vector<Label> labels;
  const auto& joints = drawing.skeleton.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].bone) continue;
    const bool is_right_bone = index(mirrored(*joints[i].bone)) < index(*joints[i].bone);
    // In the front picture, the left side and the middle are on the right of the page.
    if (is_right_bone == right) continue;
    labels.push_back({view.on_page(drawing.world[i].translation), &joints[i]});
  }
  std::ranges::stable_sort(labels, {}, [](const Label& label) { return label.at.y; });
  const double column = view.across_middle + (right ? 1.0 : -1.0) * view.to_names;
  double next = kMargin;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const auto left_over = static_cast<double>(labels.size() - k - 1);
    const double lowest = kPictureHeight - kMargin - left_over * (kLetters + 4.0);
    const double y = std::min(std::max(labels[k].at.y, next), lowest);
    next = y + kLetters + 4.0;
    const Joint& joint = *labels[k].joint;
    choose(pen, {0.8, 0.8, 0.8});
    line(pen, labels[k].at, {column, y}, 0.6);
    choose(pen, colour_of(joint));
    std::string text(name(*joint.bone));
    if (joint.name != text) text += " (" + joint.name.substr(0, 22) + ")";
    cairo_text_extents_t extents;
    cairo_text_extents(pen, text.c_str(), &extents);
    cairo_move_to(pen, right ? column + 4.0 : column - 4.0 - extents.x_advance, y + 5.0);
    cairo_show_text(pen, text.c_str());
  }
}

void draw_floor(cairo_t* pen, const View& view) {
  const double y = view.on_page({0, 0, 0}).y;
  choose(pen, {0.75, 0.75, 0.75});
  const double half = 0.15 * kWidth;
  line(pen, {view.across_middle - half, y}, {view.across_middle + half, y}, 1.0);
}

void draw(cairo_t* pen, const Skeleton& skeleton, std::string_view title) {
  choose(pen, {1, 1, 1});
  cairo_paint(pen);
  cairo_select_font_face(
      pen, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(pen, kLetters);
  const Drawing drawing = drawing_of(skeleton);
  const glm::dvec3 size = drawing.high - drawing.low;
  const double widest = std::max({size.x, size.z, 1e-6});
  const double per_metre = std::min(
      0.25 * kWidth / widest, (kPictureHeight - 3.0 * kMargin) / std::max(size.y, 1e-6));
  const glm::dvec3 middle = 0.5 * (drawing.high + drawing.low);
  for (const bool front : {true, false}) {
    View view;
    view.is_front = front;
    view.middle_m = view.seen(middle);
    view.across_middle = (front ? 0.30 : 0.74) * kWidth;
    view.to_names = (front ? 0.14 : 0.11) * kWidth;
    view.per_metre = per_metre;
    draw_floor(pen, view);
    for (const bool right : {false, true}) {
      if (front || !right) draw_names(pen, drawing, view, front ? right : true);
    }
    draw_bones(pen, drawing, view);
    choose(pen, {0.15, 0.15, 0.15});
    cairo_move_to(pen, view.across_middle - 60.0, kPictureHeight - 15.0);
    cairo_show_text(pen, front ? "from the front" : "from its left side");
  }
  choose(pen, {0.15, 0.15, 0.15});
  cairo_move_to(pen, 20.0, 25.0);
  const std::string text(title);
  cairo_show_text(pen, text.c_str());
  std::array<char, 60> scale{};
  std::snprintf(scale.data(), scale.size(), "%.3g m tall", size.y);
  cairo_move_to(pen, 20.0, kPictureHeight - 15.0);
  cairo_show_text(pen, scale.data());
}

}  // namespace

Status write_skeleton_picture(const std::filesystem::path& path,
                              const Skeleton& skeleton,
                              std::string_view title) {
  const std::string kind = kind_by_extension(path);
  if (kind != ".svg" && kind != ".png") {
    return bad_input(path.string(),
                     "cannot draw a " + in_quotes(kind) + " file",
                     "name the picture .svg or .png");
  }
  std::string bytes;
  {
    const bool is_svg = kind == ".svg";
    const Surface surface(
        is_svg ? cairo_svg_surface_create_for_stream(
                     append_bytes, &bytes, kWidth, kPictureHeight)
               : cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                            static_cast<int>(kWidth),
                                            static_cast<int>(kPictureHeight)),
        cairo_surface_destroy);
    const Pen pen(cairo_create(surface.get()), cairo_destroy);
    draw(pen.get(), skeleton, title);
    cairo_status_t status = cairo_status(pen.get());
    if (status == CAIRO_STATUS_SUCCESS && !is_svg) {
      status = cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes);
    }
    if (status != CAIRO_STATUS_SUCCESS) {
      return Error{
          Errc::kInternal,
          path.string(),
          std::string("the picture was not drawn: ") + cairo_status_to_string(status),
          "report this with the body's file"};
    }
    cairo_surface_finish(surface.get());
  }
  return write_file(path, bytes);
}

}  // namespace marey::recordings

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/dynamics/jump_panel.h"

#include <string>
#include <utility>

#include "core/humanoid.h"
#include "core/pose.h"

namespace marey {
namespace {

// Places and scales of the picture. [px]
constexpr double kFloor = 362.0;
constexpr double kPerMetre = 122.0;  ///< Scale of the bodies.
constexpr double kColumn = 56.0;     ///< From one instant's body to the next one's.
// Curves of the height.
constexpr double kPerSecond = 124.0;
constexpr double kCurvePerMetre = 110.0;
constexpr double kCurveFloor = 614.0;  ///< Place of height 0.
constexpr double kCurveLow_m = 0.4;
constexpr double kCurveHigh_m = 1.72;
constexpr double kTakeoffAt = 152.0;  ///< From the panel's left.

/// Attributes of words on lines: a white edge.
constexpr const char* kOnLines =
    " paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"4\" "
    "stroke-linejoin=\"round\" ";

constexpr Colours kGhost{"#d4d4d4", "#d4d4d4", "#e0e0e0"};

constexpr std::array kInstants{"P1", "P2", "P3", "apex", "P4", "P5"};
constexpr std::array kInstantWords{
    "start", "lowest", "take-off", "", "touch-down", "rest"};

/// Draws one posture with its centre of mass in the column at `x`.
class BodyDrawer {
 public:
  BodyDrawer(Drawing& drawing,
             const retarget::BodyMap& map,
             const glm::dvec3& right_in_world)
      : drawing_(drawing), map_(map), right_in_world_(right_in_world) {}

  void draw(const ShownJump& jump, double time_s, double x, const Colours& colours) {
    const std::size_t k = jump.frame(time_s);
    joints_ = world_from_joints(jump.motion.skeleton, jump.motion.poses[k]);
    com_in_world_ = jump.com_in_world[k];
    x_ = x;
    using enum HumanBone;
    leg({kLeftUpperLeg, kLeftLowerLeg, kLeftFoot, kLeftToes}, colours.far_limb);
    arm({kLeftUpperArm, kLeftLowerArm, kLeftHand}, colours.far_limb);
    const Place hips = middle(kLeftUpperLeg, kRightUpperLeg);
    const Place shoulders = middle(kLeftUpperArm, kRightUpperArm);
    stroke({hips, place(kSpine), place(kChest), shoulders}, 15.0, colours.trunk);
    stroke({place(kLeftUpperArm), place(kRightUpperArm)}, 9.0, colours.trunk);
    stroke({place(kLeftUpperLeg), place(kRightUpperLeg)}, 12.0, colours.trunk);
    stroke({shoulders, place(kNeck), place(kHead)}, 6.5, colours.trunk);
    drawing_.dot(place(kHead, {0.0, 0.085, 0.02}),
                 0.105 * kPerMetre,
                 std::string("fill=\"") + colours.trunk + "\"");
    leg({kRightUpperLeg, kRightLowerLeg, kRightFoot, kRightToes}, colours.near_limb);
    arm({kRightUpperArm, kRightLowerArm, kRightHand}, colours.near_limb);
  }

  [[nodiscard]] Place com() const { return seen(com_in_world_); }

 private:
  void leg(const std::array<HumanBone, 4>& bones, const char* colour) {
    stroke({place(bones[0]), place(bones[1])}, 11.0, colour);
    stroke({place(bones[1]), place(bones[2])}, 8.5, colour);
    const Place heel = place(bones[2], {0.0, -0.058, -0.04});
    const Place tip = place(bones[3], {0.0, -0.014, 0.05});
    stroke(
        {place(bones[2]), heel, place(bones[3], {0.0, -0.012, 0.0}), tip}, 6.0, colour);
  }
  void arm(const std::array<HumanBone, 3>& bones, const char* colour) {
    stroke({place(bones[0]), place(bones[1])}, 7.5, colour);
    const double side = bones[2] == HumanBone::kLeftHand ? 0.1 : -0.1;
    stroke({place(bones[1]), place(bones[2]), place(bones[2], {side, 0.0, 0.0})},
           6.0,
           colour);
  }
  void stroke(const std::vector<Place>& points, double width, const char* colour) {
    drawing_.path(points,
                  form("fill=\"none\" stroke-width=\"%.1f\"", width) +
                      " stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke=\"" +
                      colour + "\"");
  }
  [[nodiscard]] Place seen(const glm::dvec3& p_in_world) const {
    return {x_ + kPerMetre * glm::dot(right_in_world_, p_in_world - com_in_world_),
            kFloor - kPerMetre * p_in_world.y};
  }
  [[nodiscard]] Place place(HumanBone bone, const glm::dvec3& p_in_bone = {}) const {
    return seen(joints_[index(*map_.joint_of[index(bone)])] * p_in_bone);
  }
  [[nodiscard]] Place middle(HumanBone a, HumanBone b) const {
    return {0.5 * (place(a).x + place(b).x), 0.5 * (place(a).y + place(b).y)};
  }

  Drawing& drawing_;
  const retarget::BodyMap& map_;
  const glm::dvec3& right_in_world_;
  std::vector<RigidTransform> joints_;
  glm::dvec3 com_in_world_{0.0};
  double x_ = 0.0;
};

double column_x(double left, std::size_t instant) {
  return left + 26.0 + kColumn * static_cast<double>(instant);
}

/// Track of the centre of mass through the columns: linear in time between instants.
std::vector<Place> track_of(const ShownJump& jump, double left) {
  std::vector<Place> out;
  constexpr int kSteps = 30;
  for (std::size_t i = 0; i + 1 < jump.times_s.size(); ++i) {
    for (int k = i == 0 ? 0 : 1; k <= kSteps; ++k) {
      const double part = static_cast<double>(k) / kSteps;
      const double time_s = std::lerp(jump.times_s[i], jump.times_s[i + 1], part);
      out.push_back({column_x(left, i) + kColumn * part,
                     kFloor - kPerMetre * jump.com_at(time_s).y});
    }
  }
  return out;
}

std::string paint(const char* colour, double width, const char* more = "") {
  return std::string("fill=\"none\" stroke=\"") + colour + "\" " +
         form("stroke-width=\"%.1f\" ", width) + more;
}

void draw_bodies(Drawing& drawing,
                 const retarget::BodyMap& map,
                 const glm::dvec3& right_in_world,
                 const JumpPanel& panel) {
  BodyDrawer bodies(drawing, map, right_in_world);
  drawing.path({{panel.left, kFloor}, {panel.left + kPanelWidth, kFloor}},
               paint("#222222", 1.5));
  if (panel.captured != nullptr) {
    for (std::size_t i = 0; i < kInstants.size(); ++i) {
      bodies.draw(
          *panel.captured, panel.captured->times_s[i], column_x(panel.left, i), kGhost);
    }
  }
  for (std::size_t i = 0; i < kInstants.size(); ++i) {
    bodies.draw(
        panel.jump, panel.jump.times_s[i], column_x(panel.left, i), panel.colours);
  }
  if (panel.captured != nullptr) {
    drawing.path(track_of(*panel.captured, panel.left), paint("#ffffff", 3.5));
    drawing.path(track_of(*panel.captured, panel.left), paint("#8c8c8c", 1.8));
  }
  const auto track = track_of(panel.jump, panel.left);
  drawing.path(track, paint("#ffffff", 4.5));
  drawing.path(track, paint(panel.colours.near_limb, 2.5));
  for (std::size_t i = 0; i < kInstants.size(); ++i) {
    const Place com{column_x(panel.left, i),
                    kFloor - kPerMetre * panel.jump.com_at(panel.jump.times_s[i]).y};
    drawing.dot(com,
                5.0,
                std::string("fill=\"#ffffff\" stroke-width=\"2.5\" stroke=\"") +
                    panel.colours.near_limb + "\"");
    const double x = column_x(panel.left, i);
    drawing.text(
        {x, kFloor + 20.0}, kInstants[i], "text-anchor=\"middle\" font-weight=\"bold\"");
    drawing.text({x, kFloor + 36.0},
                 kInstantWords[i],
                 "text-anchor=\"middle\" font-size=\"11\" fill=\"#555555\"");
  }
}

/// Draws the rise between take-off and apex at the panel's right, with its length in cm.
void draw_rise(Drawing& drawing, const JumpPanel& panel) {
  const double x = panel.left + kPanelWidth - 8.0;
  const double top = kFloor - kPerMetre * panel.jump.apex_m;
  const double bottom = top + kPerMetre * panel.jump.rise_m;
  const auto line = paint(panel.colours.trunk, 1.2, "stroke-dasharray=\"4 3\"");
  drawing.path({{column_x(panel.left, 3) + 8.0, top}, {x + 6.0, top}}, line);
  drawing.path({{column_x(panel.left, 2) + 8.0, bottom}, {x + 6.0, bottom}}, line);
  drawing.path({{x, top + 1.0}, {x, bottom - 1.0}}, paint(panel.colours.near_limb, 2.0));
  const std::string colour = std::string("fill=\"") + panel.colours.near_limb + "\"";
  for (const auto& [y, way] : {std::pair{top, 6.0}, {bottom, -6.0}}) {
    drawing.path({{x - 3.5, y + way}, {x, y}, {x + 3.5, y + way}}, colour);
  }
  drawing.text({x + 6.0, top - 8.0},
               form("%.0f cm", 1e2 * panel.jump.rise_m),
               "text-anchor=\"end\" font-weight=\"bold\" " + colour + kOnLines);
}

void draw_titles(Drawing& drawing, const JumpPanel& panel) {
  drawing.text({panel.left, 26.0},
               panel.title,
               std::string("font-size=\"18\" font-weight=\"bold\" fill=\"") +
                   panel.colours.near_limb + "\"");
  const auto& times = panel.jump.times_s;
  drawing.text({panel.left, 47.0},
               form("apex at %.0f cm, %.0f cm above take-off",
                    1e2 * panel.jump.apex_m,
                    1e2 * panel.jump.rise_m));
  drawing.text({panel.left, 66.0},
               form("%.2f s in the air; push of up to %.1f times the weight",
                    times[4] - times[2],
                    panel.jump.peak_push_g));
}

Place curve_place(const JumpPanel& panel, double time_s, double height_m) {
  return {panel.left + kTakeoffAt + kPerSecond * time_s,
          kCurveFloor - kCurvePerMetre * height_m};
}

void draw_curve(Drawing& drawing,
                const JumpPanel& panel,
                const ShownJump& jump,
                const std::string& more) {
  std::vector<Place> points;
  const double takeoff_s = jump.times_s[2];
  const double to_s = std::min(jump.times_s.back() - takeoff_s + 0.1,
                               (kPanelWidth - kTakeoffAt) / kPerSecond);
  for (double t = -kTakeoffAt / kPerSecond; t <= to_s; t += 0.005) {
    points.push_back(curve_place(panel, t, jump.com_at(takeoff_s + t).y));
  }
  drawing.path(points, more);
}

/// Writes the name of an instant next to its place on a curve.
void label_instant(Drawing& drawing, std::size_t instant, Place at) {
  const bool is_takeoff = instant == 2;
  const bool is_touchdown = instant == 4;
  const double aside = is_takeoff ? -7.0 : is_touchdown ? 7.0 : 0.0;
  const char* anchor = is_takeoff ? "end" : is_touchdown ? "start" : "middle";
  drawing.text({at.x + aside, at.y + (instant == 1 ? 17.0 : -9.0)},
               kInstants[instant],
               std::string("font-size=\"12\" text-anchor=\"") + anchor + "\"" + kOnLines);
}

void draw_curve_words(Drawing& drawing, const JumpPanel& panel, double top) {
  drawing.text(
      {panel.left, top - 8.0}, "height of the centre of mass, cm", "font-size=\"12\"");
  drawing.text({panel.left + 0.5 * kPanelWidth, kPictureHeight - 10.0},
               "time since take-off, s",
               "text-anchor=\"middle\" font-size=\"12\"");
  if (panel.captured == nullptr) return;
  drawing.text({panel.left + kPanelWidth, top - 8.0},
               "grey: captured",
               "text-anchor=\"end\" font-size=\"12\" fill=\"#6b6b6b\"");
}

/// Draws the height of the centre of mass over the time since take-off.
void draw_curves(Drawing& drawing, const JumpPanel& panel) {
  const double top = curve_place(panel, 0.0, kCurveHigh_m).y;
  const double bottom = curve_place(panel, 0.0, kCurveLow_m).y;
  const auto& times = panel.jump.times_s;
  drawing.box(
      {curve_place(panel, 0.0, 0.0).x, top},
      {kPerSecond * (times[4] - times[2]), bottom - top},
      std::string("fill-opacity=\"0.22\" fill=\"") + panel.colours.far_limb + "\"");
  for (const double cm : {50.0, 100.0, 150.0}) {
    const double y = curve_place(panel, 0.0, 1e-2 * cm).y;
    drawing.path({{panel.left, y}, {panel.left + kPanelWidth, y}}, paint("#dddddd", 1.0));
    drawing.text({panel.left - 6.0, y + 4.0},
                 form("%.0f", cm),
                 "text-anchor=\"end\" font-size=\"12\"");
  }
  for (const double t : {-1.0, -0.5, 0.0, 0.5, 1.0, 1.5}) {
    const double x = curve_place(panel, t, 0.0).x;
    drawing.path({{x, bottom}, {x, bottom + 4.0}}, paint("#222222", 1.0));
    drawing.text(
        {x, bottom + 18.0}, number("%g", t), "text-anchor=\"middle\" font-size=\"12\"");
  }
  drawing.box(
      {panel.left, top}, {kPanelWidth, bottom - top}, "fill=\"none\" stroke=\"#222222\"");
  draw_curve_words(drawing, panel, top);
  if (panel.captured != nullptr) {
    draw_curve(drawing, panel, *panel.captured, paint("#9c9c9c", 1.8));
  }
  draw_curve(drawing, panel, panel.jump, paint(panel.colours.near_limb, 2.5));
  for (std::size_t i = 0; i < kInstants.size(); ++i) {
    const Place at =
        curve_place(panel, times[i] - times[2], panel.jump.com_at(times[i]).y);
    if (at.x < panel.left || at.x > panel.left + kPanelWidth) continue;
    drawing.dot(
        at,
        4.0,
        std::string("stroke=\"#ffffff\" fill=\"") + panel.colours.near_limb + "\"");
    label_instant(drawing, i, at);
  }
}

}  // namespace

void draw_panel(Drawing& drawing,
                const retarget::BodyMap& map,
                const glm::dvec3& right_in_world,
                const JumpPanel& panel) {
  draw_titles(drawing, panel);
  draw_bodies(drawing, map, right_in_world, panel);
  draw_rise(drawing, panel);
  draw_curves(drawing, panel);
}

}  // namespace marey

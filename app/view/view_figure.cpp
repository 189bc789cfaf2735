// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_figure.h"

#include <algorithm>
#include <utility>

#include "app/motion/error_of_file.h"
#include "app/motion/foot_contacts.h"
#include "app/motion/zmp_figures.h"
#include "core/base/extension.h"
#include "retarget/body/body_map.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {
namespace {

bool is_fetched_alone(const std::filesystem::path& file) {
  const std::string kind = kind_by_extension(file);
  return kind == ".glb" || kind == ".vrm";
}

void stand_still(Motion& motion) {
  if (motion.poses.empty()) motion.poses.push_back(rest_pose(motion.skeleton));
}

/// Returns the rotation that the reader applied to the body.
glm::dquat turn_of(bool faces_back) {
  return faces_back ? glm::dquat(0.0, 0.0, 1.0, 0.0) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

/// Returns the everyday name of a contact.
std::string place_name(const std::string& joint) {
  if (joint == "leftFoot") return "left heel";
  if (joint == "leftToes") return "left ball";
  if (joint == "rightFoot") return "right heel";
  if (joint == "rightToes") return "right ball";
  return joint;
}

void add_remarks(const std::filesystem::path& file,
                 const std::vector<std::string>& of_body,
                 std::vector<std::string>& remarks) {
  for (const std::string& remark : of_body) {
    remarks.push_back(file.string() + ": " + remark);
  }
}

}  // namespace

std::optional<FigureSkin> skin_of(const std::filesystem::path& file,
                                  const ReadBody& body) {
  const auto& nodes = body.raw.node_of_joint;
  const bool has_nodes = std::ranges::find(nodes, -1) == nodes.end();
  const bool rests_as_file =
      body.neutral == NeutralKind::kRest && !body.rests_as_bound && has_nodes;
  const bool fits = body.raw.mesh && rests_as_file && is_fetched_alone(file);
  if (!fits) return std::nullopt;
  return FigureSkin{file,
                    body.raw.node_of_joint,
                    1.0 / body.frame.scale,
                    body.frame.marey_from_file * turn_of(body.raw.faces_back)};
}

Result<ViewedFigure> figure_of_file(const std::filesystem::path& file,
                                    std::vector<std::string>& remarks) {
  auto raw = read_raw_body(file);
  if (!raw) return raw.error();
  ViewedFigure figure;
  figure.name = file.stem().string();
  const Motion as_in_file = raw->motion;
  const std::vector<int> nodes = raw->node_of_joint;
  const bool faces_back = raw->faces_back;
  const bool has_skin = raw->mesh.has_value();
  auto body = identify_body(*std::move(raw), file);
  if (body) {
    add_remarks(file, body->remarks(), remarks);
    figure.skin = skin_of(file, *body);
    figure.motion = std::move(body->raw.motion);
  } else {
    remarks.push_back(body.error().message() + " The body is shown as in its file");
    figure.motion = as_in_file;
    if (has_skin && is_fetched_alone(file)) {
      figure.skin = FigureSkin{file, nodes, 1.0, turn_of(faces_back)};
    }
  }
  stand_still(figure.motion);
  return figure;
}

Result<ViewedFigure> figure_on_avatar(const Motion& motion,
                                      const std::filesystem::path& avatar,
                                      std::vector<std::string>& remarks) {
  auto body = read_body(avatar);
  if (!body) return body.error();
  add_remarks(avatar, body->remarks(), remarks);
  retarget::RetargetOptions options;
  options.soles = body->soles;
  options.skin = &body->skin;
  options.hands.emplace().avatar_volume = body->volume;
  auto retargeted = retarget::retarget_motion(motion, body->skeleton(), options);
  if (!retargeted) return of_file(avatar, retargeted.error());
  ViewedFigure figure;
  figure.name = avatar.stem().string();
  figure.kind = live::PageSkeletonKind::kAvatar;
  figure.skin = skin_of(avatar, *body);
  figure.motion = std::move(retargeted->motion);
  return figure;
}

std::vector<retarget::BalanceFrame> balance_of(const Motion& motion) {
  const auto map = retarget::map_body(motion.skeleton);
  if (!map || motion.poses.size() < 2) return {};
  const auto masses = retarget::place_masses(motion.skeleton, *map, {});
  if (!masses) return {};
  const Contacts contacts = retarget::detect_contacts(motion, *map);
  auto frames = retarget::balance_frames(motion, *map, *masses, contacts);
  const MotionZmp zmp = motion_zmp(motion, *map, contacts, *masses);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    frames[t].zmp_xz_m = zmp.frames[t].zmp_xz_m;
  }
  return frames;
}

std::vector<live::PageContact> contact_spans(const Motion& motion, int first_frame) {
  const recordings::NpzContacts contacts = foot_contacts(motion);
  std::vector<live::PageContact> out;
  const std::size_t places = contacts.names.size();
  for (std::size_t place = 0; place < places; ++place) {
    live::PageContact contact{place_name(contacts.names[place]), {}};
    bool bore = false;
    for (std::size_t i = 0; i < motion.poses.size(); ++i) {
      const bool bears = contacts.bears[i * places + place] != 0;
      const int frame = first_frame + static_cast<int>(i);
      if (bears && !bore) contact.spans.push_back({frame, frame});
      if (bears) contact.spans.back().last = frame;
      bore = bears;
    }
    out.push_back(std::move(contact));
  }
  return out;
}

std::vector<live::PageTrack> tracks_of(const ViewedFigure& figure, int first_frame) {
  std::vector<live::PageTrack> out;
  const auto& joints = figure.motion.skeleton.joints;
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    live::PageTrack track{joints[joint].name, {}};
    bool was_seen = false;
    for (std::size_t i = 0; i < figure.uncertainty.size(); ++i) {
      const Source source = figure.uncertainty[i][joint].source;
      was_seen |= source != Source::kInferred;
      add_gap(track, first_frame + static_cast<int>(i), source);
    }
    if (was_seen) out.push_back(std::move(track));
  }
  return out;
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/xml_reader.h"
#include "recordings/body/constraint_words.h"
#include "recordings/body/constraints_file.h"

namespace marey::recordings {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

constexpr Limits kPlace{-kMaxDistance_m, kMaxDistance_m, "m"};
constexpr Limits kLength{0.0, kMaxDistance_m, "m"};
constexpr Limits kTime{-1e9, 1e9, "s"};
constexpr Limits kDuration{0.0, 1e9, "s"};
constexpr Limits kImportance{1e-6, 1e6};
constexpr Limits kRange{1, 1e6};
constexpr Limits kQuaternion{-1.001, 1.001};

/// Reads the elements of constraints and converts them to marey's axes.
class ConstraintReader {
 public:
  explicit ConstraintReader(XmlReader& xml) : xml_(xml) {}

  void read_set(pugi::xml_node root, ConstraintSet& set);

 private:
  template <std::size_t kCount>
  void only(pugi::xml_node node, const std::string_view (&known)[kCount]) {  // NOLINT
    xml_.keep_unknown(node, known, nullptr);
  }
  void read_axes(pugi::xml_node root);
  glm::dvec3 read_vector(pugi::xml_node node);
  glm::dquat read_rotation(pugi::xml_node node);
  BodyPoint read_point(pugi::xml_node node);
  Activation read_activation(pugi::xml_node node);
  Goal read_goal(pugi::xml_node node, std::size_t type);
  // Reads the content of <specif>, one function per type of goal.
  void read(pugi::xml_node specif, DistanceToPoint& goal);
  void read(pugi::xml_node specif, DistanceToBody& goal);
  void read(pugi::xml_node specif, DistanceToConstraint& goal);
  void read(pugi::xml_node specif, AllowedSpace& goal);
  void read(pugi::xml_node specif, ForbiddenSpace& goal);
  void read(pugi::xml_node specif, SegmentOrientation& goal);
  void read(pugi::xml_node specif, Support& goal);
  template <class Space>
  void read_space(pugi::xml_node specif, Space& space);
  Constraint read_constraint(pugi::xml_node node, std::size_t type);

  XmlReader& xml_;
  bool z_up_ = false;
};

/// Removes the known attributes of the root element, so that they cause no notes.
void take_attributes(pugi::xml_node root) {
  root.remove_attribute("xmlns");
  root.remove_attribute("up");
}

void ConstraintReader::read_axes(pugi::xml_node root) {
  const std::string_view up = root.attribute("up").as_string("Y");
  z_up_ = up == "Z";
  if (up == "Y" || up == "Z") return;
  xml_.fail(root,
            "up is \"" + std::string(up) + "\" and may be \"Y\" or \"Z\"",
            "write up=\"Y\" or up=\"Z\"");
}

glm::dvec3 ConstraintReader::read_vector(pugi::xml_node node) {
  only(node, {"X", "Y", "Z"});
  const double x = xml_.number(xml_.need(node, "X"), kPlace);
  const double y = xml_.number(xml_.need(node, "Y"), kPlace);
  const double z = xml_.number(xml_.need(node, "Z"), kPlace);
  // Subtracted from 0, to avoid -0.
  return z_up_ ? glm::dvec3(x, z, 0.0 - y) : glm::dvec3(x, y, z);
}

glm::dquat ConstraintReader::read_rotation(pugi::xml_node node) {
  only(node, {"W", "X", "Y", "Z"});
  const double w = xml_.number(xml_.need(node, "W"), kQuaternion);
  const double x = xml_.number(xml_.need(node, "X"), kQuaternion);
  const double y = xml_.number(xml_.need(node, "Y"), kQuaternion);
  const double z = xml_.number(xml_.need(node, "Z"), kQuaternion);
  const glm::dquat rotation =
      z_up_ ? glm::dquat(w, x, z, 0.0 - y) : glm::dquat(w, x, y, z);
  constexpr double kRounded = 1e-3;  // Three digits, the usual rounding by hand.
  if (node && std::abs(glm::length(rotation) - 1.0) > kRounded) {
    xml_.fail(node, "<orientation> is not a unit quaternion", "divide it by its length");
  }
  return xml_.mistake() || !node ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                 : normalized_once(rotation);
}

BodyPoint ConstraintReader::read_point(pugi::xml_node node) {
  only(node, {"segment", "localOffset"});
  BodyPoint point;
  point.segment = vrm_segment(xml_.name(xml_.need(node, "segment")));
  if (const pugi::xml_node offset = xml_.child(node, "localOffset")) {
    point.offset_in_t_pose = read_vector(offset);
  }
  return point;
}

Activation ConstraintReader::read_activation(pugi::xml_node node) {
  Activation activation;
  if (const pugi::xml_node start = xml_.child(node, "start_time")) {
    activation.start_s = xml_.number(start, kTime);
  }
  if (const pugi::xml_node stop = xml_.child(node, "stop_time")) {
    activation.stop_s = xml_.number(stop, kTime);
  }
  activation.start_duration_s =
      xml_.number(xml_.child(node, "start_duration"), kDuration);
  activation.stop_duration_s = xml_.number(xml_.child(node, "stop_duration"), kDuration);
  return activation;
}

void ConstraintReader::read(pugi::xml_node specif, DistanceToPoint& goal) {
  only(specif, {"distance", "position"});
  goal.distance_m = xml_.number(xml_.need(specif, "distance"), kLength);
  goal.p_in_world = read_vector(xml_.need(specif, "position"));
}

void ConstraintReader::read(pugi::xml_node specif, DistanceToBody& goal) {
  only(specif, {"distance", "bodyPoint"});
  goal.distance_m = xml_.number(xml_.need(specif, "distance"), kLength);
  goal.other = read_point(xml_.need(specif, "bodyPoint"));
}

void ConstraintReader::read(pugi::xml_node specif, DistanceToConstraint& goal) {
  only(specif, {"distance", "constraint"});
  goal.distance_m = xml_.number(xml_.need(specif, "distance"), kLength);
  goal.other_id = xml_.name(xml_.need(specif, "constraint"));
}

template <class Space>
void ConstraintReader::read_space(pugi::xml_node specif, Space& space) {
  only(specif, {"min", "max"});
  space.min_in_world = read_vector(xml_.need(specif, "min"));
  space.max_in_world = read_vector(xml_.need(specif, "max"));
  // The ends of the negated axis are exchanged.
  if (z_up_) std::swap(space.min_in_world.z, space.max_in_world.z);
}

void ConstraintReader::read(pugi::xml_node specif, AllowedSpace& goal) {
  read_space(specif, goal);
}

void ConstraintReader::read(pugi::xml_node specif, ForbiddenSpace& goal) {
  read_space(specif, goal);
}

void ConstraintReader::read(pugi::xml_node specif, SegmentOrientation& goal) {
  only(specif, {"orientation"});
  goal.world_from_t_pose = read_rotation(xml_.need(specif, "orientation"));
}

void ConstraintReader::read(pugi::xml_node specif, Support& goal) {
  only(specif, {"position", "orientation"});
  if (const pugi::xml_node position = xml_.child(specif, "position")) {
    goal.footprint_in_world = read_vector(position);
  }
  if (const pugi::xml_node orientation = xml_.child(specif, "orientation")) {
    goal.world_from_t_pose = read_rotation(orientation);
  }
}

/// Returns a goal of each type, in the order of kGoalElements.
template <std::size_t... kType>
std::array<Goal, sizeof...(kType)> empty_goals(std::index_sequence<kType...> /*types*/) {
  return {std::variant_alternative_t<kType, Goal>{}...};
}

Goal ConstraintReader::read_goal(pugi::xml_node node, std::size_t type) {
  constexpr auto kTypes = std::make_index_sequence<std::variant_size_v<Goal>>{};
  Goal goal = empty_goals(kTypes)[type];
  const bool may_be_left_out = std::holds_alternative<Support>(goal);
  const pugi::xml_node specif =
      may_be_left_out ? xml_.child(node, "specif") : xml_.need(node, "specif");
  std::visit([&](auto& kind) { read(specif, kind); }, goal);
  return goal;
}

Constraint ConstraintReader::read_constraint(pugi::xml_node node, std::size_t type) {
  Constraint constraint;
  constraint.id = xml_.name(xml_.need(node, "name"));
  if (const pugi::xml_node priority = xml_.child(node, "priority")) {
    constraint.importance = xml_.number(priority, kImportance);
  }
  if (const pugi::xml_node accuracy = xml_.child(node, "accuracy")) {
    constraint.precision_m = xml_.number(accuracy, kLength);
  }
  constraint.activation = read_activation(node);
  if (const pugi::xml_node range = xml_.child(node, "range")) {
    constraint.range = xml_.integer(range, kRange);
  }
  constraint.point = read_point(xml_.need(node, "bodyPoint"));
  constraint.goal = read_goal(node, type);
  constexpr std::array<std::string_view, 10> kKnown{"name",
                                                    "priority",
                                                    "accuracy",
                                                    "start_time",
                                                    "stop_time",
                                                    "start_duration",
                                                    "stop_duration",
                                                    "range",
                                                    "bodyPoint",
                                                    "specif"};
  xml_.keep_unknown(node, kKnown, &constraint.unknown_xml);
  return constraint;
}

void ConstraintReader::read_set(pugi::xml_node root, ConstraintSet& set) {
  read_axes(root);
  take_attributes(root);
  std::map<std::string, int> line_of_name;
  bool keeps_some = false;
  for (const pugi::xml_node& node : root.children()) {
    const auto* const type =
        std::find(kGoalElements.begin(), kGoalElements.end(), node.name());
    if (node.type() != pugi::node_element || type == kGoalElements.end()) continue;
    if (xml_.mistake()) return;
    Constraint constraint =
        read_constraint(node, static_cast<std::size_t>(type - kGoalElements.begin()));
    const int line = xml_.line(node);
    const auto [first, is_new] = line_of_name.emplace(constraint.id, line);
    if (!is_new) {
      xml_.fail(node,
                "a constraint named \"" + constraint.id + "\" is on line " +
                    std::to_string(first->second) + " already",
                "give it another name, or remove it");
    }
    keeps_some = keeps_some || !constraint.unknown_xml.empty();
    set.constraints.push_back(std::move(constraint));
  }
  xml_.keep_unknown(root, kGoalElements, &set.unknown_xml);
  if (z_up_ && (keeps_some || !set.unknown_xml.empty())) {
    xml_.note(root, "unknown content is kept and still has Z up");
  }
}

Error too_big(const std::string& file) {
  return bad_input(file,
                   "the file has more than 16 MiB, which constraints never need",
                   "name a file of constraints, or split it");
}

}  // namespace

Result<ConstraintFile> parse_constraints(std::string_view text, const std::string& file) {
  if (text.size() > kMaxBytes) return too_big(file);
  XmlReader xml(text, file);
  ConstraintFile read;
  if (const pugi::xml_node root = xml.root("ConstraintsSet")) {
    ConstraintReader(xml).read_set(root, read.set);
  }
  if (xml.mistake()) return *xml.mistake();
  read.notes = xml.notes();
  return read;
}

Result<ConstraintFile> read_constraints(const std::filesystem::path& path) {
  std::error_code unknown;  // The reader then reports the error.
  const auto size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > kMaxBytes) return too_big(path.string());
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_constraints(*text, path.string());
}

}  // namespace marey::recordings

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/xml_reader.h"
#include "recordings/body/constraint_words.h"
#include "recordings/body/constraints_file.h"

namespace marey::recordings {
namespace {

/// Writes XML in the form of the annex: two blanks per level, values on their elements'
/// lines.
class XmlWriter {
 public:
  void open(std::string_view name) {
    indent().append("<").append(name).append(">\n");
    ++depth_;
  }
  void close(std::string_view name) {
    --depth_;
    indent().append("</").append(name).append(">\n");
  }
  void text(std::string_view name, std::string_view value) {
    indent().append("<").append(name).append(">");
    append_xml_text(xml_, value);
    xml_.append("</").append(name).append(">\n");
  }
  template <class Number>
  void number(std::string_view name, Number value) {
    std::string digits;
    append_exact(digits, value);
    text(name, digits);
  }
  void vector(std::string_view name, const glm::dvec3& v) {
    open(name);
    number("X", v.x);
    number("Y", v.y);
    number("Z", v.z);
    close(name);
  }
  void rotation(const glm::dquat& q) {
    const glm::dquat unit = glm::length(q) > 0.0 ? normalized_once(q) : q;
    open("orientation");
    number("W", unit.w);
    number("X", unit.x);
    number("Y", unit.y);
    number("Z", unit.z);
    close("orientation");
  }
  void point(const BodyPoint& point) {
    open("bodyPoint");
    text("segment", vrm_segment(point.segment));
    vector("localOffset", point.offset_in_t_pose);
    close("bodyPoint");
  }
  void verbatim(const std::vector<std::string>& elements) {
    for (const std::string& element : elements) indent().append(element).append("\n");
  }
  [[nodiscard]] const std::string& xml() const { return xml_; }

 private:
  std::string& indent() { return xml_.append(2 * depth_, ' '); }

  std::string xml_;
  std::size_t depth_ = 1;  ///< Inside the root.
};

// Writes the content of <specif>, one function per type of goal.
void write_goal(XmlWriter& out, const DistanceToPoint& goal) {
  out.number("distance", goal.distance_m);
  out.vector("position", goal.p_in_world);
}
void write_goal(XmlWriter& out, const DistanceToBody& goal) {
  out.number("distance", goal.distance_m);
  out.point(goal.other);
}
void write_goal(XmlWriter& out, const DistanceToConstraint& goal) {
  out.number("distance", goal.distance_m);
  out.text("constraint", goal.other_id);
}
void write_goal(XmlWriter& out, const AllowedSpace& goal) {
  out.vector("min", goal.min_in_world);
  out.vector("max", goal.max_in_world);
}
void write_goal(XmlWriter& out, const ForbiddenSpace& goal) {
  out.vector("min", goal.min_in_world);
  out.vector("max", goal.max_in_world);
}
void write_goal(XmlWriter& out, const SegmentOrientation& goal) {
  out.rotation(goal.world_from_t_pose);
}
void write_goal(XmlWriter& out, const Support& goal) {
  if (goal.footprint_in_world) out.vector("position", *goal.footprint_in_world);
  if (goal.world_from_t_pose) out.rotation(*goal.world_from_t_pose);
}

void write_constraint(XmlWriter& out, const Constraint& constraint) {
  const std::string_view element = kGoalElements[constraint.goal.index()];
  const Activation& activation = constraint.activation;
  out.open(element);
  out.text("name", constraint.id);
  out.number("priority", constraint.importance);
  out.number("accuracy", constraint.precision_m);
  if (activation.start_s) out.number("start_time", *activation.start_s);
  if (activation.stop_s) out.number("stop_time", *activation.stop_s);
  out.number("start_duration", activation.start_duration_s);
  out.number("stop_duration", activation.stop_duration_s);
  if (constraint.range) out.number("range", *constraint.range);
  out.point(constraint.point);
  out.open("specif");
  std::visit([&](const auto& goal) { write_goal(out, goal); }, constraint.goal);
  out.close("specif");
  out.verbatim(constraint.unknown_xml);
  out.close(element);
}

std::string text_of(const ConstraintSet& set) {
  XmlWriter out;
  for (const Constraint& constraint : set.constraints) write_constraint(out, constraint);
  out.verbatim(set.unknown_xml);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\" ?>\n"
         "<ConstraintsSet xmlns=\"ContraintesXML\">\n" +
         out.xml() + "</ConstraintsSet>\n";
}

/// Returns the reason why the set could not be read back unchanged; nullopt if it can.
std::optional<Error> refusal(const ConstraintSet& set, const std::string& where) {
  const std::string text = text_of(set);
  const Result<ConstraintFile> again = parse_constraints(text, where);
  if (!again) {
    return bad_input(
        where, "cannot be written: " + again.error().cause, again.error().next);
  }
  if (text_of(again->set) == text) return std::nullopt;
  return bad_input(where,
                   "cannot be written: it would be read as something else",
                   "give it names without blanks at their ends, and one XML element in "
                   "each text of unknown_xml");
}

}  // namespace

Result<std::string> constraints_text(const ConstraintSet& set) {
  for (const Constraint& constraint : set.constraints) {
    const std::string where = "constraint " + in_quotes(constraint.id);
    if (auto error = refusal({{constraint}, {}}, where)) return *error;
  }
  if (auto error = refusal(set, "the set of constraints")) return *error;
  return text_of(set);
}

Status write_constraints(const std::filesystem::path& path, const ConstraintSet& set) {
  const Result<std::string> text = constraints_text(set);
  if (!text) return text.error();
  return write_file(path, *text);
}

}  // namespace marey::recordings

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/record/request_fields.h"

#include <cmath>
#include <cstdint>

namespace marey::engine {
namespace {

constexpr double kLargestWhole = 9007199254740992.0;  // 2^53

// Both visit the members of a request in the same order.
class FieldWriter {
 public:
  explicit FieldWriter(EngineRequest& out) : out_(out) {}
  void real(double& value) { out_.numbers.push_back(value); }
  void real(float& value) { out_.numbers.push_back(static_cast<double>(value)); }
  template <class Whole>
  void whole(Whole& value, double, double) {
    out_.numbers.push_back(static_cast<double>(value));
  }
  void text(std::string& value) { out_.texts.push_back(value); }
  template <class Value, class Visit>
  void maybe(std::optional<Value>& value, const Visit& visit) {
    out_.numbers.push_back(value ? 1.0 : 0.0);
    if (value) visit(*value);
  }

 private:
  EngineRequest& out_;
};

class FieldReader {
 public:
  explicit FieldReader(const EngineRequest& in) : in_(in) {}
  void real(double& value) { value = next(); }
  void real(float& value) { value = static_cast<float>(next()); }
  template <class Whole>
  void whole(Whole& value, double least, double most) {
    const double number = next();
    // False for NaN.
    const bool is_valid =
        number >= least && number <= most && number == std::floor(number);
    if (is_valid) {
      value = static_cast<Whole>(static_cast<std::int64_t>(number));
    } else {
      is_good_ = false;
    }
  }
  void text(std::string& value) {
    if (text_ < in_.texts.size()) {
      value = in_.texts[text_++];
    } else {
      is_good_ = false;
    }
  }
  template <class Value, class Visit>
  void maybe(std::optional<Value>& value, const Visit& visit) {
    bool is_there = false;
    whole(is_there, 0.0, 1.0);
    value.reset();
    if (is_there) visit(value.emplace());
  }
  [[nodiscard]] bool is_done() const {
    return is_good_ && number_ == in_.numbers.size() && text_ == in_.texts.size();
  }

 private:
  double next() {
    if (number_ < in_.numbers.size()) return in_.numbers[number_++];
    is_good_ = false;
    return 0.0;
  }
  const EngineRequest& in_;
  std::size_t number_ = 0;
  std::size_t text_ = 0;
  bool is_good_ = true;
};

template <class Fields, class Vector>
void visit_vector(Fields& fields, Vector& v) {
  for (int i = 0; i < v.length(); ++i) fields.real(v[i]);
}

template <class Fields>
void visit(Fields& fields, ActionStart& start) {
  fields.whole(start.kind, 0.0, static_cast<double>(ActionStart::Kind::kAtEvent));
  fields.real(start.time_s);
  fields.whole(start.action, 0.0, kLargestWhole);
  fields.text(start.event);
}

template <class Fields>
void visit(Fields& fields, ActionWish& wish) {
  const auto real = [&](double& value) { fields.real(value); };
  fields.text(wish.clip);
  for (float& priority : wish.priority) fields.real(priority);
  fields.real(wish.weight);
  fields.maybe(wish.layer,
               [&](int& layer) { fields.whole(layer, -2147483648.0, 2147483647.0); });
  fields.real(wish.fade_in_s);
  fields.real(wish.fade_out_s);
  fields.real(wish.rate);
  fields.maybe(wish.loops, [&](bool& loops) { fields.whole(loops, 0.0, 1.0); });
  visit(fields, wish.start);
  fields.whole(wish.transition, 0.0, static_cast<double>(TransitionKind::kCut));
  fields.maybe(wish.entry_s, real);
  fields.real(wish.entry_search_s);
  fields.whole(wish.replaces, 0.0, 1.0);
}

template <class Fields>
void visit(Fields& fields, SteerWish& wish) {
  visit(fields, wish.action);
  visit_vector(fields, wish.goal_xz_m);
  SteerSettings& s = wish.settings;
  for (double* value : {&s.max_turn_rad,
                        &s.max_turn_rad_s,
                        &s.min_scale,
                        &s.max_scale,
                        &s.keep_s,
                        &s.max_duration_s,
                        &s.stop_m}) {
    fields.real(*value);
  }
}

template <class Fields>
void visit(Fields& fields, ReachTarget& target) {
  visit_vector(fields, target.p_in_world);
  visit_vector(fields, target.velocity_m_s);
  fields.maybe(target.approach, [&](glm::dvec3& v) { visit_vector(fields, v); });
  fields.maybe(target.speed_m_s, [&](double& v) { fields.real(v); });
  fields.maybe(target.world_from_hand, [&](glm::dquat& q) { visit_vector(fields, q); });
  visit_vector(fields, target.turn_rad_s);
}

template <class Fields>
void visit(Fields& fields, ReachWish& wish) {
  visit(fields, wish.action);
  fields.whole(wish.side, 0.0, 1.0);
  fields.text(wish.arrive);
  visit(fields, wish.target);
  ReachOptions& o = wish.options;
  fields.whole(o.after, 0.0, static_cast<double>(AfterArrival::kReturn));
  for (double* value : {&o.max_acceleration_m_s2,
                        &o.max_turn_acceleration_rad_s2,
                        &o.approach_speed_m_s,
                        &o.trust_s,
                        &o.settle_s,
                        &o.return_s}) {
    fields.real(*value);
  }
  for (double* value : {&wish.share.lean_rad,
                        &wish.share.step_legs,
                        &wish.share.max_extension,
                        &wish.share.min_elbow_rad}) {
    fields.real(*value);
  }
}

template <class Fields>
void visit(Fields& fields, ThrowWish& wish) {
  const auto real = [&](double& value) { fields.real(value); };
  const auto vector = [&](glm::dvec3& value) { visit_vector(fields, value); };
  visit(fields, wish.action);
  fields.whole(wish.side, 0.0, 1.0);
  fields.text(wish.release);
  ThrowChanges& asked = wish.asked;
  for (std::optional<double>* value : {&asked.x_m,
                                       &asked.y_m,
                                       &asked.z_m,
                                       &asked.azimuth_rad,
                                       &asked.elevation_rad,
                                       &asked.speed_m_s,
                                       &asked.release_s}) {
    fields.maybe(*value, real);
  }
  fields.maybe(wish.aim_in_world, vector);
  fields.whole(wish.arc, 0.0, static_cast<double>(BallArc::kSteep));
  fields.real(wish.ball.gravity_m_s2);
  fields.real(wish.ball.drag_1_m);
  fields.real(wish.ball.max_time_s);
  fields.maybe(wish.ball_in_hand_m, vector);
  fields.real(wish.half_width_s);
}

template <class Fields>
void visit(Fields& fields, LiveWish& wish) {
  visit(fields, wish.action);
  LiveOptions& o = wish.options;
  for (double* value : {&o.max_sigma_m,
                        &o.max_age_s,
                        &o.good_s,
                        &o.share_half_life_s,
                        &o.extrapolate_half_life_s,
                        &o.gap_s,
                        &o.gap_half_life_s}) {
    fields.real(*value);
  }
}

template <class Fields>
void visit(Fields& fields, LivePosture& live) {
  fields.real(live.time_s);
  BlendPosture& p = live.posture;
  for (auto* lanes : {&p.x, &p.y, &p.z, &p.w}) {
    for (float& value : *lanes) fields.real(value);
  }
  for (auto* limbs :
       {&p.fold_rad, &p.mid_x, &p.mid_y, &p.upper_twist_rad, &p.lower_twist_rad}) {
    for (float& value : *limbs) fields.real(value);
  }
  fields.real(p.height_legs);
  fields.real(p.abdomen_share);
  fields.real(p.torso_share);
  fields.real(live.root_legs.x_m);
  fields.real(live.root_legs.z_m);
  fields.real(live.root_legs.heading_rad);
  for (float& sigma_m : live.sigma_m) fields.real(sigma_m);
  fields.whole(live.bears, 0.0, 15.0);
}

template <class Value>
void write(Value value, EngineRequest& out) {
  FieldWriter fields(out);
  visit(fields, value);
}

template <class Value>
std::optional<Value> read(const EngineRequest& request) {
  Value out;
  FieldReader fields(request);
  visit(fields, out);
  return fields.is_done() ? std::optional<Value>(std::move(out)) : std::nullopt;
}

}  // namespace

void write_fields(const ActionWish& wish, EngineRequest& out) {
  write(wish, out);
}
void write_fields(const SteerWish& wish, EngineRequest& out) {
  write(wish, out);
}
void write_fields(const ReachWish& wish, EngineRequest& out) {
  write(wish, out);
}
void write_fields(const ThrowWish& wish, EngineRequest& out) {
  write(wish, out);
}
void write_fields(const LiveWish& wish, EngineRequest& out) {
  write(wish, out);
}
void write_fields(const ReachTarget& target, EngineRequest& out) {
  write(target, out);
}
void write_fields(const LivePosture& posture, EngineRequest& out) {
  write(posture, out);
}

template <>
std::optional<ActionWish> read_fields(const EngineRequest& request) {
  return read<ActionWish>(request);
}
template <>
std::optional<SteerWish> read_fields(const EngineRequest& request) {
  return read<SteerWish>(request);
}
template <>
std::optional<ReachWish> read_fields(const EngineRequest& request) {
  return read<ReachWish>(request);
}
template <>
std::optional<ThrowWish> read_fields(const EngineRequest& request) {
  return read<ThrowWish>(request);
}
template <>
std::optional<LiveWish> read_fields(const EngineRequest& request) {
  return read<LiveWish>(request);
}
template <>
std::optional<ReachTarget> read_fields(const EngineRequest& request) {
  return read<ReachTarget>(request);
}
template <>
std::optional<LivePosture> read_fields(const EngineRequest& request) {
  return read<LivePosture>(request);
}

}  // namespace marey::engine

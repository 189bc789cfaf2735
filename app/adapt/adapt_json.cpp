// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_json.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "app/adapt/frame_time.h"
#include "app/motion/zmp_figures.h"
#include "core/base/degrees.h"
#include "core/base/format_text.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;
using retarget::KeptConstraint;

constexpr double kFirmFoot_m = 1e-3;

double time_of(const AdaptRun& run, int frame) {
  return frame_time_s(run.adapted.motion, frame);
}

bool is_missed(const KeptConstraint& kept) {
  return kept.met_frames < kept.active_frames;
}

Json figures_of(const KeptConstraint& kept, const AdaptRun& run) {
  Json out{{"id", kept.id},
           {"support", kept.is_support},
           {"active_frames", kept.active_frames},
           {"met_frames", kept.met_frames}};
  if (kept.active_frames == 0) return out;
  if (kept.is_orientation) {
    out["mean_error_deg"] = kDegreesPerRadian * kept.mean_error_rad;
    out["worst_error_deg"] = kDegreesPerRadian * kept.worst_error_rad;
  } else {
    out["mean_error_mm"] = 1e3 * kept.mean_error_m;
    out["worst_error_mm"] = 1e3 * kept.worst_error_m;
  }
  out["worst_frame"] = *kept.worst_frame;
  out["worst_time_s"] = time_of(run, *kept.worst_frame);
  return out;
}

Json constraints_json(const std::vector<KeptConstraint>& kept, const AdaptRun& run) {
  Json out = Json::array();
  for (const KeptConstraint& one : kept) out.push_back(figures_of(one, run));
  return out;
}

/// Returns the stances of a support: floor part, time and slide.
Json stands_of(const std::vector<retarget::SupportSlide>& slides, const AdaptRun& run) {
  Json out = Json::array();
  for (const retarget::SupportSlide& slide : slides) {
    const retarget::FloorStance& stance = slide.stance;
    out.push_back({{"on", stance.part ? run.floor.parts[*stance.part].name : ""},
                   {"from_s", time_of(run, stance.frames.first)},
                   {"to_s", time_of(run, stance.frames.last)},
                   {"slide_mm", 1e3 * slide.slide_m}});
  }
  return out;
}

Json found_supports_of(const AdaptRun& run) {
  Json out = constraints_json(run.adapted.supports, run);
  for (std::size_t i = 0; i < run.slides.size(); ++i) {
    out[i]["stands"] = stands_of(run.slides[i], run);
  }
  return out;
}

double worst_slide_m(const AdaptRun& run) {
  double worst = 0.0;
  for (const auto& slides : run.slides) {
    for (const auto& slide : slides) worst = std::max(worst, slide.slide_m);
  }
  return worst;
}

template <class Counts>
double worst_m(const AdaptRun& run, const Counts& counts) {
  double worst = 0.0;
  for (const auto* all : {&run.adapted.constraints, &run.adapted.supports}) {
    for (const KeptConstraint& kept : *all) {
      if (counts(kept)) worst = std::max(worst, kept.worst_error_m);
    }
  }
  return worst;
}

bool is_support_entry(const KeptConstraint& kept) {
  return kept.is_support;
}

/// Returns the worst error of the constraints that are no supports: "12.3 mm", "4.5
/// degrees", or both.
std::string worst_miss_of(const retarget::AdaptedMotion& adapted) {
  double worst_m = 0.0;
  double worst_rad = 0.0;
  for (const KeptConstraint& kept : adapted.constraints) {
    if (kept.is_support || !is_missed(kept)) continue;
    worst_m = std::max(worst_m, kept.worst_error_m);
    worst_rad = std::max(worst_rad, kept.worst_error_rad);
  }
  std::string text;
  if (worst_m > 0.0) text = format_text("%.1f mm", 1e3 * worst_m);
  if (worst_m > 0.0 && worst_rad > 0.0) text += " and ";
  if (worst_rad > 0.0) text += format_text("%.1f degrees", kDegreesPerRadian * worst_rad);
  return text;
}

std::string more_iterations(const AdaptArguments& args) {
  return "allow more than " + std::to_string(args.options.max_iterations) +
         " with --max-iterations";
}

/// Returns true if more iterations are likely to meet a constraint that reached the
/// limit: the limit was low and more iterations were tried with success, or the error is
/// small. A target far out of reach is not met by any number of iterations.
bool is_nearly_there(const KeptConstraint& kept,
                     const AdaptArguments& args,
                     const AdaptRun& run) {
  constexpr double kLittle_m = 0.02;
  constexpr double kLittle_deg = 5.0;
  const std::size_t at = static_cast<std::size_t>(&kept - run.adapted.constraints.data());
  if (args.options.max_iterations < retarget::AdaptOptions{}.max_iterations) {
    return at < run.more_iterations_help.size() && run.more_iterations_help[at];
  }
  return kept.worst_error_m < kLittle_m &&
         kDegreesPerRadian * kept.worst_error_rad < kLittle_deg;
}

/// Returns advice for the most likely obstacle to a constraint.
std::string advice_for(const KeptConstraint& kept,
                       const AdaptArguments& args,
                       const AdaptRun& run) {
  const Constraint* own = run.constraints.find(kept.id);
  if (kept.ran_out && is_nearly_there(kept, args, run)) return more_iterations(args);
  if (own != nullptr && own->range) {
    return "let more segments turn for it: use a larger <range>, or none";
  }
  const retarget::AdaptOptions& options = args.options;
  if (options.root_for_constraints < 1.0) return "let the root help: --root-share 1";
  if (options.control == retarget::Control::kBlend &&
      run.constraints.constraints.size() > 1) {
    return "raise its importance against the others', or use --control priority";
  }
  if (own != nullptr) {
    for (const Constraint& other : run.constraints.constraints) {
      if (other.importance > own->importance) {
        return "\"" + other.id +
               "\" has priority over it: exchange their importance, or "
               "move one of the two";
      }
    }
  }
  if (options.balance != retarget::BalanceMode::kOff) {
    return "move its target nearer, or leave out --balance";
  }
  return "move its target nearer to the body, or remove the support of a foot";
}

std::string miss_of(const KeptConstraint& kept, const AdaptRun& run) {
  return format_text("missed in %d of %d frames, by up to %.1f %s (at %.2f s)",
                     kept.active_frames - kept.met_frames,
                     kept.active_frames,
                     kept.is_orientation ? kDegreesPerRadian * kept.worst_error_rad
                                         : 1e3 * kept.worst_error_m,
                     kept.is_orientation ? "degrees" : "mm",
                     time_of(run, *kept.worst_frame));
}

constexpr const char* kDepartureAdvice =
    "move targets nearer, leave out --balance, or use --method thesis";

/// Returns advice for a centre of mass that is off its target.
std::string balance_advice(const AdaptArguments& args, const AdaptRun& run) {
  if (run.adapted.capped_frames > 0) return more_iterations(args);
  if (args.options.root_for_balance < 1.0) {
    return "let the root help: --balance-root-share 1";
  }
  if (!args.balance_groups.empty()) return "let more --balance-groups move for it";
  return "move targets nearer, or reduce the load";
}

}  // namespace

Json adapt_json(const AdaptArguments& args, const AdaptRun& run) {
  const retarget::AdaptedMotion& adapted = run.adapted;
  const std::size_t frames = adapted.motion.poses.size();
  Json out{{"out", args.out.string()},
           {"character", run.character},
           {"frames", frames},
           {"rate_hz", adapted.motion.rate.hz},
           {"floor_height_m", run.floor_height_m},
           {"constraints", constraints_json(adapted.constraints, run)},
           {"supports", found_supports_of(run)},
           {"worst_support_mm", 1e3 * worst_m(run, is_support_entry)},
           {"worst_slide_mm", 1e3 * worst_slide_m(run)}};
  if (!args.floor.empty()) out["floor_out_of_reach_frames"] = run.out_of_reach_frames;
  if (args.options.balance != retarget::BalanceMode::kOff) {
    out["balance"] = {{"mean_error_mm", 1e3 * adapted.mean_balance_error_m},
                      {"worst_error_mm", 1e3 * adapted.worst_balance_error_m}};
  }
  if (run.zmp) out["zmp"] = zmp_json(*run.zmp);
  const retarget::AddedAcceleration& added = adapted.added;
  out["added_acceleration"] = {{"m_per_s2", added.m_per_s2},
                               {"joint", adapted.motion.skeleton[added.joint].name},
                               {"time_s", time_of(run, added.frame)}};
  out["departure"] = departure_json(run.departure, adapted.motion);
  out["posture"] = posture_json(run.posture, adapted.motion);
  out["iterations"] = {{"mean", adapted.mean_iterations},
                       {"most", adapted.max_iterations},
                       {"frames_at_cap", adapted.capped_frames}};
  out["us_per_frame"] =
      frames > 0 ? 1e6 * run.adapt_s / static_cast<double>(frames) : 0.0;
  return out;
}

std::string adapt_summary(const AdaptArguments& args, const AdaptRun& run) {
  const retarget::AdaptedMotion& adapted = run.adapted;
  const std::size_t frames = adapted.motion.poses.size();
  std::size_t met = 0;
  std::size_t wanted = 0;
  for (const KeptConstraint& kept : adapted.constraints) {
    if (kept.is_support || kept.active_frames == 0) continue;
    ++wanted;
    if (!is_missed(kept)) ++met;
  }
  std::string text = args.out.string() + ": " + std::to_string(frames) + " frames";
  if (wanted > 0) {
    text += format_text(", %zu of %zu constraints met", met, wanted);
    if (met < wanted) {
      text += " (worst " + worst_miss_of(adapted) + " off)";
    }
  }
  text += format_text(", supports within %.2f mm", 1e3 * worst_m(run, is_support_entry));
  if (args.options.balance != retarget::BalanceMode::kOff) {
    text += format_text(", balance within %.1f mm", 1e3 * adapted.worst_balance_error_m);
  }
  text += departure_summary(run.departure);
  return text +
         format_text(", %.0f us a frame",
                     frames > 0 ? 1e6 * run.adapt_s / static_cast<double>(frames) : 0.0);
}

const KeptConstraint* find_failure(const AdaptArguments& args, const AdaptRun& run) {
  for (const auto* all : {&run.adapted.constraints, &run.adapted.supports}) {
    for (const KeptConstraint& kept : *all) {
      if (kept.is_support && kept.worst_error_m > kFirmFoot_m) return &kept;
    }
  }
  if (args.options.control == retarget::Control::kBlend) return nullptr;
  for (const KeptConstraint& kept : run.adapted.constraints) {
    const int missed = kept.active_frames - kept.met_frames;
    if (!kept.is_support && 2 * missed > kept.active_frames) return &kept;
  }
  return nullptr;
}

std::optional<Finding> assess_failure(const AdaptArguments& args, const AdaptRun& run) {
  const KeptConstraint* failure = find_failure(args, run);
  if (failure == nullptr) {
    if (run.source_finding) return run.source_finding;
    const auto problem = assess_posture(
        args.out.string(), run.posture, run.adapted.motion, run.constraints);
    if (problem && problem->severity == Severity::kPoor) return problem;
    if (!is_needlessly_far(run.departure)) return std::nullopt;
    return poor_finding("departure",
                        args.out.string(),
                        departure_text(run.departure, run.adapted.motion),
                        kDepartureAdvice);
  }
  return poor_finding("constraint",
                      args.out.string(),
                      (failure->is_support ? "support \"" : "constraint \"") +
                          failure->id + "\": " + miss_of(*failure, run),
                      failure->is_support ? "move its footprint into the leg's reach"
                                          : advice_for(*failure, args, run));
}

std::vector<Finding> assess_adapted(const AdaptArguments& args, const AdaptRun& run) {
  std::vector<Finding> out;
  const retarget::AdaptedMotion& adapted = run.adapted;
  const KeptConstraint* failure = find_failure(args, run);
  for (const KeptConstraint& kept : adapted.constraints) {
    const std::string where =
        args.constraints.string() + ": constraint \"" + kept.id + "\"";
    if (kept.active_frames == 0) {
      const int last = static_cast<int>(adapted.motion.poses.size()) - 1;
      out.push_back(fair_finding(
          "inactive",
          where,
          format_text("fully active in no frame of the motion, which lasts from %.2f s "
                      "to %.2f s",
                      time_of(run, 0),
                      time_of(run, last)),
          "check its times"));
    } else if (is_missed(kept) && &kept != failure) {
      out.push_back(fair_finding(
          "constraint", where, miss_of(kept, run), advice_for(kept, args, run)));
    }
  }
  if (run.out_of_reach_frames > 0) {
    out.push_back(fair_finding(
        "reach",
        args.floor.string(),
        format_text("in %d of %zu frames a standing leg does not reach it at any height "
                    "of the hips",
                    run.out_of_reach_frames,
                    adapted.motion.poses.size()),
        "lower or move its parts"));
  }
  for (const KeptConstraint& kept : adapted.supports) {
    if (kept.worst_error_m <= kFirmFoot_m || &kept == failure) continue;
    out.push_back(fair_finding("support",
                               args.motion.string() + ": support \"" + kept.id + "\"",
                               miss_of(kept, run)));
  }
  constexpr double kOffBalance_m = 0.01;
  if (adapted.worst_balance_error_m > kOffBalance_m) {
    out.push_back(fair_finding(
        "balance",
        args.out.string(),
        format_text("the centre of mass is up to %.1f mm from its target (at %.2f s)",
                    1e3 * adapted.worst_balance_error_m,
                    time_of(run, adapted.worst_balance_frame)),
        balance_advice(args, run)));
  }
  constexpr double kJump_m_per_s2 = 100.0;
  if (adapted.added.m_per_s2 > kJump_m_per_s2) {
    out.push_back(fair_finding(
        "jump",
        args.out.string(),
        format_text("%s jumps at %.2f s, with %.0f m/s2 of added acceleration",
                    adapted.motion.skeleton[adapted.added.joint].name.c_str(),
                    time_of(run, adapted.added.frame),
                    adapted.added.m_per_s2),
        "give constraints longer start and stop durations, or nearer targets"));
  }
  const auto problem =
      assess_posture(args.out.string(), run.posture, adapted.motion, run.constraints);
  if (run.source_finding && failure != nullptr) out.push_back(*run.source_finding);
  if (problem &&
      (problem->severity < Severity::kPoor || failure != nullptr || run.source_finding)) {
    out.push_back(*problem);
  }
  const std::string far = departure_text(run.departure, adapted.motion);
  if (!far.empty() && (failure != nullptr || !is_needlessly_far(run.departure))) {
    const bool balances = args.options.balance != retarget::BalanceMode::kOff;
    out.push_back(
        fair_finding("departure",
                     args.out.string(),
                     far,
                     balances ? kDepartureAdvice : "move targets nearer to the body"));
  }
  // All of these are warnings: another finding determines the exit code.
  for (Finding& finding : out) finding.severity = Severity::kFair;
  return out;
}

}  // namespace marey::app

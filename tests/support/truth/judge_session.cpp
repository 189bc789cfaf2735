// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/judge_session.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/quantile.h"
#include "core/pose.h"

namespace marey::testing {
namespace {

using B = HumanBone;

constexpr double kGross_m = 0.060;
constexpr double kMinGross_m = 0.020;
constexpr double kGrossSigmas = 5.0;
constexpr int kSpikeRun = 3;
constexpr double kSpikeShare = 0.05;
constexpr double kMisplaced_m = 0.020;
constexpr double kFlipDegrees = 60.0;
// The 95 % point of chi squared with three degrees of freedom.
constexpr double kChi2At95 = 7.815;

/// One joint of one frame.
struct JointSample {
  Source source = Source::kInferred;
  double error_m = 0.0;
  double sigma_m = 0.0;
  bool is_flipped = false;  ///< The segment on one of its sides.

  [[nodiscard]] bool is_gross() const {
    if (source != Source::kMeasured) return false;
    return error_m > kGross_m ||
           (error_m > kMinGross_m && error_m > kGrossSigmas * sigma_m);
  }
};

JointKind kind_of(std::size_t limb, std::size_t place) {
  return static_cast<JointKind>((limb < 2 ? 0 : 3) + static_cast<int>(place));
}

/// The segment with tags on the trunk's side of a limb's joint.
B trunkward(B joint) {
  const B up = *parent(joint);
  const bool is_clavicle = up == B::kLeftShoulder || up == B::kRightShoulder;
  return is_clavicle ? B::kUpperChest : up;
}

using JointSamples = std::map<B, std::vector<JointSample>>;

bool is_flipped(const RigidTransform& is, const RigidTransform& found) {
  const glm::dquat off = glm::conjugate(is.rotation) * found.rotation;
  return glm::length(rotation_vector(off)) > glm::radians(kFlipDegrees);
}

JointSamples sample(const SimulatedSession& session,
                    const EstimatedMotion& estimate,
                    SessionVerdict& verdict) {
  JointSamples samples;
  const Motion& motion = estimate.motion;
  std::vector<B> worn;
  for (const GluedTag& tag : session.tags) {
    if (std::find(worn.begin(), worn.end(), tag.tag.segment) == worn.end()) {
      worn.push_back(tag.tag.segment);
    }
  }
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const double time_s = (motion.first_frame + static_cast<double>(f)) / motion.rate.hz;
    const BoneFrames truth = session.truth(session.motion, time_s);
    const auto found = world_from_joints(motion.skeleton, motion.poses[f]);
    const auto flipped = [&](B bone) {
      return is_flipped(truth[index(bone)], found[index(bone)]);
    };
    for (const B bone : worn) {
      const bool measured =
          estimate.uncertainty[f][index(bone)].source == Source::kMeasured;
      verdict.flipped_frames += measured && flipped(bone) ? 1 : 0;
    }
    for (const HumanLimb& limb : human_limbs()) {
      for (const B joint : {limb.upper, limb.lower, limb.end}) {
        const JointUncertainty& uncertainty = estimate.uncertainty[f][index(joint)];
        samples[joint].push_back({uncertainty.source,
                                  glm::distance(truth[index(joint)].translation,
                                                found[index(joint)].translation),
                                  uncertainty.sigma_m,
                                  flipped(joint) || flipped(trunkward(joint))});
      }
    }
  }
  return samples;
}

/// By how much the fit has a joint in the wrong place in the frames of tags.
struct TagErrors {
  std::vector<double> off_m;
  double worst_m = 0.0;
  int worst_id = 0;
  int worst_sightings = 0;
};

void add_tag_errors(const SimulatedSession& session,
                    const Body& body,
                    B segment,
                    const glm::dvec3& joint_in_truth,
                    const glm::dvec3& joint_in_fit,
                    TagErrors& errors) {
  for (const GluedTag& glued : session.tags) {
    if (glued.tag.segment != segment) continue;
    for (const PlacedTag& placed : body.tags) {
      if (placed.tag.id != glued.tag.id) continue;
      const double off_m = glm::distance(inverse(glued.segment_from_tag) * joint_in_truth,
                                         inverse(placed.segment_from_tag) * joint_in_fit);
      errors.off_m.push_back(off_m);
      if (off_m <= errors.worst_m) continue;
      errors.worst_m = off_m;
      errors.worst_id = number(glued.tag.id);
      errors.worst_sightings = placed.sightings;
    }
  }
}

TagErrors tag_errors(const SimulatedSession& session, const Body& body, B joint) {
  TagErrors errors;
  add_tag_errors(session, body, joint, glm::dvec3(0.0), glm::dvec3(0.0), errors);
  const B up = *parent(joint);
  add_tag_errors(session,
                 body,
                 up,
                 session.body.proportions[joint],
                 body.proportions[joint],
                 errors);
  return errors;
}

/// Share of the frames of the range of motion in which two cameras see tags of a segment.
double share_seen_twice(const SimulatedSession& session, B segment) {
  const auto& detections = session.moving.detections;
  const std::size_t frames = detections.front().frames.size();
  std::size_t twice = 0;
  for (std::size_t f = 0; f < frames; ++f) {
    int cameras = 0;
    for (const CameraDetections& camera : detections) {
      const auto& tags = camera.frames[f].tags;
      cameras += std::any_of(tags.begin(), tags.end(), [&](const TagDetection& seen) {
        return std::any_of(
            session.tags.begin(), session.tags.end(), [&](const GluedTag& tag) {
              return tag.tag.id == seen.id && tag.tag.segment == segment;
            });
      });
    }
    twice += cameras >= 2 ? 1 : 0;
  }
  return static_cast<double>(twice) /
         static_cast<double>(std::max<std::size_t>(frames, 1));
}

int tags_on(const SimulatedSession& session, B segment) {
  return static_cast<int>(
      std::count_if(session.tags.begin(), session.tags.end(), [&](const GluedTag& tag) {
        return tag.tag.segment == segment;
      }));
}

void explain(const SimulatedSession& session,
             const Body& body,
             const std::vector<JointSample>& samples,
             GrossJoint& gross) {
  const auto flips =
      std::count_if(samples.begin(), samples.end(), [](const JointSample& s) {
        return s.is_gross() && s.is_flipped;
      });
  const TagErrors errors = tag_errors(session, body, gross.joint);
  const auto misplaced = std::count_if(errors.off_m.begin(),
                                       errors.off_m.end(),
                                       [](double off) { return off > kMisplaced_m; });
  if (2 * flips >= gross.gross_frames) {
    gross.cause = "flip";
  } else if (misplaced == 0) {
    gross.cause = "motion";
  } else if (misplaced == 1 && errors.off_m.size() > 1) {
    gross.cause = "one-tag";
  } else {
    gross.cause = "fit";
  }
  const B up = trunkward(gross.joint);
  std::array<char, 300> line{};
  std::snprintf(line.data(),
                line.size(),
                "%s: %d of %d frames, worst %.0f mm at sigma %.1f (%s); tag %d placed "
                "%.0f mm wrong of %d sightings; tags %d on %s (seen by two %.0f %%), %d "
                "on %s (%.0f %%)",
                std::string(name(gross.joint)).c_str(),
                gross.gross_frames,
                gross.measured_frames,
                1e3 * gross.worst_m,
                1e3 * gross.sigma_m,
                gross.cause.c_str(),
                errors.worst_id,
                1e3 * errors.worst_m,
                errors.worst_sightings,
                tags_on(session, up),
                std::string(name(up)).c_str(),
                100.0 * share_seen_twice(session, up),
                tags_on(session, gross.joint),
                std::string(name(gross.joint)).c_str(),
                100.0 * share_seen_twice(session, gross.joint));
  gross.details = line.data();
}

std::optional<GrossJoint> gross_joint(B joint, const std::vector<JointSample>& samples) {
  GrossJoint gross;
  gross.joint = joint;
  int run = 0;
  for (const JointSample& s : samples) {
    gross.measured_frames += s.source == Source::kMeasured ? 1 : 0;
    run = s.is_gross() ? run + 1 : 0;
    gross.max_run = std::max(gross.max_run, run);
    if (!s.is_gross()) continue;
    ++gross.gross_frames;
    if (s.error_m <= gross.worst_m) continue;
    gross.worst_m = s.error_m;
    gross.sigma_m = s.sigma_m;
  }
  if (gross.gross_frames == 0) return std::nullopt;
  gross.is_persistent =
      gross.max_run > kSpikeRun ||
      gross.gross_frames > kSpikeShare * static_cast<double>(samples.size());
  return gross;
}

void judge_lengths(const SimulatedSession& session,
                   const Body& body,
                   SessionVerdict& verdict) {
  for (const HumanLimb& limb : human_limbs()) {
    for (const B joint : {limb.lower, limb.end}) {
      const double is_m = glm::length(session.body.proportions[joint]);
      const double off_m = std::abs(glm::length(body.proportions[joint]) - is_m);
      ++verdict.lengths.count;
      verdict.lengths.inside +=
          off_m < 1.96 * body.joint_centre_sigma_m[index(joint)] ? 1 : 0;
      verdict.worst_length_share = std::max(verdict.worst_length_share, off_m / is_m);
    }
  }
}

bool is_inside(const JointSample& sample) {
  const double in_sigmas = sample.error_m / sample.sigma_m;
  return in_sigmas * in_sigmas <= kChi2At95;
}

void judge_joints(const JointSamples& samples, SessionVerdict& verdict) {
  for (const auto& [joint, of_joint] : samples) {
    for (const Source source :
         {Source::kMeasured, Source::kRepaired, Source::kInferred}) {
      JointFigures figures{joint, source, {}, 0.0, 0.0};
      std::vector<double> errors_m;
      std::vector<double> sigmas_m;
      for (const JointSample& s : of_joint) {
        if (s.source != source) continue;
        errors_m.push_back(s.error_m);
        sigmas_m.push_back(s.sigma_m);
        ++figures.honest.count;
        figures.honest.inside += is_inside(s) ? 1 : 0;
      }
      if (errors_m.empty()) continue;
      figures.median_error_m = median(std::move(errors_m));
      figures.median_sigma_m = median(std::move(sigmas_m));
      verdict.joints.push_back(figures);
    }
  }
}

void judge_sigmas(const JointSamples& samples, SessionVerdict& verdict) {
  std::vector<double> measured_m;
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    const std::array<B, 3> joints{bones.upper, bones.lower, bones.end};
    for (std::size_t place = 0; place < joints.size(); ++place) {
      const auto kind = static_cast<std::size_t>(kind_of(limb, place));
      for (const JointSample& s : samples.at(joints[place])) {
        Tally& tally = verdict.honest[static_cast<std::size_t>(s.source)][kind];
        ++tally.count;
        tally.inside += is_inside(s) ? 1 : 0;
        if (s.source == Source::kMeasured) measured_m.push_back(s.error_m);
      }
    }
  }
  if (measured_m.empty()) return;
  verdict.median_m = median(measured_m);
  verdict.p95_m = quantile(measured_m, 0.95);
  verdict.max_m = quantile(measured_m, 1.0);
}

}  // namespace

SessionVerdict judge(const SimulatedSession& session, const SessionAnswer& answer) {
  SessionVerdict verdict;
  verdict.is_refused = answer.refusal.has_value();
  if (verdict.is_refused || answer.motion.motion.poses.empty()) return verdict;
  const JointSamples samples = sample(session, answer.motion, verdict);
  judge_sigmas(samples, verdict);
  judge_joints(samples, verdict);
  judge_lengths(session, answer.body, verdict);
  for (const auto& [joint, of_joint] : samples) {
    auto gross = gross_joint(joint, of_joint);
    if (!gross) continue;
    explain(session, answer.body, of_joint, *gross);
    if (gross->is_persistent) {
      verdict.is_silently_wrong = true;
    } else {
      verdict.spike_frames += gross->gross_frames;
    }
    verdict.gross.push_back(std::move(*gross));
  }
  verdict.is_partial = !answer.left_out.empty() && !verdict.is_silently_wrong;
  return verdict;
}

std::string message_class(const Error& error) {
  std::string out;
  bool is_quoted = false;
  for (const char c : error.cause) {
    if (c == '"') {
      if (!is_quoted) out += "\"...";
      is_quoted = !is_quoted;
      if (is_quoted) continue;
    }
    if (is_quoted) continue;
    const bool is_digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (is_digit && !out.empty() && out.back() == '#') continue;
    out += is_digit ? '#' : c;
  }
  return out;
}

}  // namespace marey::testing

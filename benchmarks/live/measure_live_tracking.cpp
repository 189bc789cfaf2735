// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Measures the accuracy and the speed of live tracking of a body, against the batch solve
// of the same tags and against the truth of a rendered recording:
//
//   measure_live_tracking OUT TRUTH KEEP TRIAL...
//
// OUT is the output folder of `marey process`: its calibration and subject are used.
// TRUTH holds TRIAL/cam0.mp4... and TRIAL/truth/joints.csv (see the recording's README).
// KEEP is a folder in which detected tags are kept from run to run. Neither solver
// receives the cameras' lags. Prints results for tags of the full detector and of the
// live tag tracker, for all cameras and for the first two. The results are mean and 95 %
// errors of the twelve joints of the limbs, with the ratio of live to batch in brackets;
// share and mean error of the joints with a sigma below 20 mm; and milliseconds of
// processor time of BodyTracker::step() per frame (median, 95 %, worst). The errors of
// each joint follow. Then prints for each trial the delay of the body after the mean
// instant of the cameras' pictures [ms], with no camera as the reference. The delay is
// measured with all pictures and with half of them left out in three ways
// (tests/support/truth/motion_delay.h).

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/live/live_trails.h"
#include "capture/search/detect_videos.h"
#include "core/base/quantile.h"
#include "reconstruct/tags/solve_motion.h"
#include "reconstruct/tags/track_body.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/detections_file.h"
#include "recordings/session/subject_file.h"
#include "tests/support/truth/truth.h"

namespace {

namespace fs = std::filesystem;
using marey::CameraDetections;
using marey::HumanBone;

struct Scene {
  marey::Body body;
  std::vector<marey::Camera> cameras;
  fs::path truth;
  fs::path keep;
};

// Joints with a smaller sigma count as known.
constexpr double kKnown_m = 0.02;

struct Errors {
  std::vector<double> mm;
  std::vector<double> known_mm;  ///< Errors of joints with a sigma below kKnown_m.
  std::map<HumanBone, std::vector<double>> by_joint_mm;

  void add(const marey::testing::TruthJoints& truth,
           int frame,
           const marey::Skeleton& skeleton,
           const marey::Pose& pose,
           const std::vector<marey::JointUncertainty>& uncertainty) {
    const auto world = world_from_joints(skeleton, pose);
    for (const HumanBone bone : marey::human_bones()) {
      const auto place = truth.find({frame, bone});
      if (place == truth.end()) continue;
      const double off_mm =
          1e3 * glm::distance(world[marey::index(bone)].translation, place->second);
      mm.push_back(off_mm);
      if (uncertainty[marey::index(bone)].sigma_m < kKnown_m) known_mm.push_back(off_mm);
      by_joint_mm[bone].push_back(off_mm);
    }
  }
  void add(const Errors& other) {
    mm.insert(mm.end(), other.mm.begin(), other.mm.end());
    known_mm.insert(known_mm.end(), other.known_mm.begin(), other.known_mm.end());
  }
};

/// Returns the processor time of this thread, which excludes other load on the machine.
double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

struct Live {
  Errors errors;
  std::vector<double> step_ms;
  int missed = 0;  ///< Frames without a pose, or lost.
  std::vector<double> lags_ms;
};

bool fail(const marey::Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return false;
}

/// One camera's tags, detected once and then kept.
marey::Result<CameraDetections> detect_camera(const Scene& scene,
                                              const std::string& trial,
                                              bool full,
                                              std::size_t camera) {
  const std::string name = scene.cameras[camera].name;
  const fs::path kept =
      scene.keep / (trial + "-" + name + (full ? "-full" : "-live") + ".json");
  auto read = marey::recordings::read_detections(kept, "measure_live_tracking");
  if (read && *read) return std::move(**read);
  marey::capture::CameraInput input;
  input.path = scene.truth / trial / (name + ".mp4");
  input.camera = static_cast<marey::CameraId>(camera);
  marey::capture::DetectVideosOptions options;
  options.search_every_frame = full;
  options.tracker = marey::capture::live_tracking();
  auto found = marey::capture::detect_tags_in_videos({&input, 1}, options);
  if (!found) return found.error();
  fs::create_directories(scene.keep);
  const auto written =
      marey::recordings::write_detections(kept, found->front(), "measure_live_tracking");
  if (!written) return written.error();
  return std::move(found->front());
}

marey::Result<std::vector<CameraDetections>> detect(const Scene& scene,
                                                    const std::string& trial,
                                                    bool full) {
  std::vector<CameraDetections> all;
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    auto found = detect_camera(scene, trial, full, c);
    if (!found) return found.error();
    found->camera = static_cast<marey::CameraId>(c);
    found->offset.reset();
    for (marey::FrameDetections& frame : found->frames) {
      for (marey::TagDetection& tag : frame.tags) {
        tag.corners_px = unshrunk(tag.corners_px, scene.cameras[c].tag_shrinkage);
      }
    }
    all.push_back(std::move(*found));
  }
  return all;
}

std::optional<Live> follow(const Scene& scene,
                           const marey::testing::TruthJoints& truth,
                           const std::vector<CameraDetections>& detections) {
  const std::span cameras = std::span(scene.cameras).first(detections.size());
  auto tracker = marey::reconstruct::BodyTracker::create(
      scene.body, cameras, detections.front().rate);
  if (!tracker) {
    fail(tracker.error());
    return std::nullopt;
  }
  Live live;
  marey::Pose pose;
  std::vector<marey::JointUncertainty> uncertainty;
  std::vector<marey::reconstruct::CameraView> views(detections.size());
  for (std::size_t f = 0; f < detections.front().frames.size(); ++f) {
    for (std::size_t c = 0; c < detections.size(); ++c) {
      views[c].tags = {};
      if (f < detections[c].frames.size()) views[c].tags = detections[c].frames[f].tags;
    }
    const double before_ms = processor_ms();
    const bool found =
        tracker->step(views, 1.0 / detections.front().rate.hz, pose, uncertainty);
    live.step_ms.push_back(processor_ms() - before_ms);
    live.missed += tracker->last().state != marey::reconstruct::TrackState::kTracked;
    if (found) {
      live.errors.add(truth, static_cast<int>(f), tracker->skeleton(), pose, uncertainty);
    }
  }
  for (const double lag_s : tracker->lags_s()) live.lags_ms.push_back(1e3 * lag_s);
  return live;
}

std::optional<Errors> solve(const Scene& scene,
                            const marey::testing::TruthJoints& truth,
                            const std::vector<CameraDetections>& detections) {
  const std::span cameras = std::span(scene.cameras).first(detections.size());
  const auto trial = marey::reconstruct::solve_motion(scene.body, cameras, detections);
  if (!trial) {
    fail(trial.error());
    return std::nullopt;
  }
  Errors errors;
  const marey::Motion& motion = trial->estimate.motion;
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    errors.add(truth,
               motion.first_frame + static_cast<int>(f),
               motion.skeleton,
               motion.poses[f],
               trial->estimate.uncertainty[f]);
  }
  return errors;
}

bool print_trails(const Scene& scene,
                  const std::string& trial,
                  const marey::testing::TruthJoints& truth,
                  const std::vector<CameraDetections>& detections) {
  const auto cameras =
      marey::testing::truth_cameras(scene.truth / trial / "truth" / "cameras.json");
  double mean_ms = 0.0;
  for (std::size_t c = 0; cameras && c < detections.size(); ++c) {
    mean_ms += 1e3 * (*cameras)[c].offset_s / static_cast<double>(detections.size());
  }
  const auto trails = marey::benchmarks::live_trails(
      scene.body, std::span(scene.cameras).first(detections.size()), truth, detections);
  if (!trails) return fail(trails.error());
  std::printf("    trails its stamps, ms:");
  for (const auto& trail : *trails) {
    std::printf(" %s %.2f;", trail.pictures, trail.delay_ms + mean_ms);
  }
  std::printf("\n");
  return true;
}

void print(const std::string& trial,
           const char* tags,
           std::size_t cameras,
           const Errors& batch,
           const Live& live) {
  const Errors& found = live.errors;
  std::printf("%-6s %zu cameras, %s: batch %.2f, live %.2f mm (%.2f); 95 %% %.1f, %.1f\n",
              trial.c_str(),
              cameras,
              tags,
              mean(batch.mm),
              mean(found.mm),
              mean(found.mm) / mean(batch.mm),
              marey::quantile(batch.mm, 0.95),
              marey::quantile(found.mm, 0.95));
  std::printf(
      "    known: %.1f %% %.2f, %.1f %% %.2f mm; %d frames without; ms %.2f %.2f %.2f",
      100.0 * static_cast<double>(batch.known_mm.size()) /
          static_cast<double>(batch.mm.size()),
      mean(batch.known_mm),
      100.0 * static_cast<double>(found.known_mm.size()) /
          static_cast<double>(found.mm.size()),
      mean(found.known_mm),
      live.missed,
      marey::quantile(live.step_ms, 0.5),
      marey::quantile(live.step_ms, 0.95),
      marey::quantile(live.step_ms, 1.0));
  if (!live.lags_ms.empty()) std::printf("; lags ms");
  for (const double lag_ms : live.lags_ms) std::printf(" %.1f", lag_ms);
  std::printf("\n");
}

void print_joints(const Errors& batch, const Live& live) {
  for (const auto& [bone, mm] : live.errors.by_joint_mm) {
    const std::vector<double>& of_batch = batch.by_joint_mm.at(bone);
    std::printf("    %-14s batch %6.2f, live %6.2f mm; max %6.1f, %6.1f\n",
                std::string(marey::name(bone)).c_str(),
                mean(of_batch),
                mean(mm),
                marey::quantile(of_batch, 1.0),
                marey::quantile(mm, 1.0));
  }
}

bool measure(const Scene& scene, const std::vector<std::string>& trials) {
  for (const std::size_t cameras : {scene.cameras.size(), std::size_t{2}}) {
    for (const bool full : {true, false}) {
      Errors all_batch;
      Live all_live;
      const char* tags = full ? "full" : "tracked";
      for (const std::string& trial : trials) {
        const auto truth =
            marey::testing::truth_joints(scene.truth / trial / "truth" / "joints.csv");
        auto detections = detect(scene, trial, full);
        if (!detections) return fail(detections.error());
        detections->resize(cameras);
        const auto batch = truth ? solve(scene, *truth, *detections) : std::nullopt;
        const auto live = truth ? follow(scene, *truth, *detections) : std::nullopt;
        if (!batch || !live) return false;
        print(trial, tags, cameras, *batch, *live);
        print_joints(*batch, *live);
        if (!print_trails(scene, trial, *truth, *detections)) return false;
        all_batch.add(*batch);
        all_live.errors.add(live->errors);
        all_live.missed += live->missed;
        all_live.step_ms.insert(
            all_live.step_ms.end(), live->step_ms.begin(), live->step_ms.end());
      }
      print("all", tags, cameras, all_batch, all_live);
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: measure_live_tracking OUT TRUTH KEEP TRIAL...\n");
    return 2;
  }
  const fs::path out = argv[1];
  const auto calibration = marey::recordings::read_calibration(out / "calibration.toml");
  const auto body = marey::recordings::read_subject(out / "subject.toml");
  if (!calibration) return fail(calibration.error()) ? 0 : 1;
  if (!body) return fail(body.error()) ? 0 : 1;
  const Scene scene{*body, calibration->cameras, argv[2], argv[3]};
  return measure(scene, {argv + 4, argv + argc}) ? 0 : 1;
}

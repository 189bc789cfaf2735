// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pipeline.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>
#include <thread>

#include "app/draw_frames.h"
#include "app/report_figures.h"
#include "app/retarget_files.h"
#include "app/version.h"
#include "capture/detect_videos.h"
#include "reconstruct/check_views.h"
#include "reconstruct/fit_subject.h"
#include "recordings/atomic_file.h"
#include "recordings/bvh.h"
#include "recordings/calibration_file.h"
#include "recordings/content_key.h"
#include "recordings/detections_file.h"
#include "recordings/gltf.h"
#include "recordings/mannequin.h"
#include "recordings/motion_tables.h"
#include "recordings/subject_file.h"
#include "retarget/retarget_motion.h"

namespace marey::app {
namespace {

using recordings::Trial;
using recordings::TrialKind;
using recordings::TrialVideo;

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The error with its file: rooms that see no files leave the place empty, or name a
/// table of session.toml, "[board]".
Error at(const std::string& file, Error error) {
  if (error.where.empty()) {
    error.where = file;
  } else if (error.where.front() == '[') {
    error.where = file + ": " + error.where;
  }
  return error;
}

Error missing_trial(const recordings::Session& session, TrialKind kind) {
  return bad_input(
      session.file.string(),
      "there is no trial of kind \"" + std::string(recordings::name(kind)) + "\"",
      "record one and add it as a [[trial]]");
}

/// What a cached detection depends on.
Result<std::string> cache_key(const TrialVideo& video,
                              const Trial& trial,
                              const std::string& family) {
  const auto content = recordings::content_key(video.path);
  if (!content) return content.error();
  // Raise the number when the detector finds other corners in the same picture.
  std::string key = *content + " detector-2 " + family;
  if (trial.frames) {
    key += " frames " + std::to_string(trial.frames->first) + "-" +
           std::to_string(trial.frames->last);
  }
  return key;
}

Status check_seen(const CameraDetections& camera) {
  const bool any = std::any_of(camera.frames.begin(),
                               camera.frames.end(),
                               [](const FrameDetections& f) { return !f.tags.empty(); });
  if (any) return Done{};
  return bad_input(
      camera.source,
      "not a single tag is seen in its " + std::to_string(camera.frames.size()) +
          " frames",
      "check that the video is of this trial and sharp, and the tag family in "
      "session.toml; or leave this camera out of the trial");
}

/// Frames are matched by their number: all videos of a trial must run at one rate.
/// Cameras without a video in the trial take that rate.
Status check_rates(const recordings::Session& session,
                   const Trial& trial,
                   std::vector<CameraDetections>& cameras) {
  const CameraDetections& first = cameras[index(trial.videos.front().camera)];
  for (CameraDetections& camera : cameras) {
    if (camera.frames.empty()) {
      camera.rate = first.rate;
      camera.source = session.file.string();
      continue;
    }
    if (std::abs(camera.rate.hz / first.rate.hz - 1.0) < 1e-3) continue;
    std::array<char, 120> text{};
    std::snprintf(text.data(),
                  text.size(),
                  "runs at %.3f frames per second, %s at %.3f",
                  camera.rate.hz,
                  session.cameras[index(first.camera)].c_str(),
                  first.rate.hz);
    return bad_input(camera.source,
                     text.data(),
                     "record all cameras at one rate, or give the trial an fps in "
                     "session.toml if the files state it wrongly");
  }
  return Done{};
}

/// Runs `work(i)` for all i below `count` on as many threads as there are cores.
template <class Work>
void in_parallel(std::size_t count, const Work& work) {
  const std::size_t threads =
      std::min<std::size_t>(count, std::max(1U, std::thread::hardware_concurrency()));
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> workers;
  for (std::size_t t = 0; t < threads; ++t) {
    workers.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    });
  }
  for (std::thread& worker : workers) worker.join();
}

}  // namespace

Pipeline::Pipeline(recordings::Session session, PipelineOptions options, Console& console)
    : session_(std::move(session)), options_(std::move(options)), console_(&console) {
  report_.session = session_.name;
  report_.version = kVersion;
}

Result<Pipeline> Pipeline::open(const PipelineOptions& options, Console& console) {
  auto session = recordings::read_session(options.session, {options.media});
  if (!session) return session.error();
  if (const Status ok = recordings::check_files(*session); !ok) return ok.error();
  std::set<std::string> names{"motion"};
  for (const auto& avatar : options.avatars) {
    if (!names.insert(avatar.stem().string()).second) {
      return bad_input(avatar.string(),
                       "two results would be called \"" + avatar.stem().string() + "\"",
                       "rename the avatar's file: results are named after it");
    }
  }
  return Pipeline(std::move(*session), options, console);
}

std::vector<const Trial*> Pipeline::motion_trials() const {
  std::vector<const Trial*> trials;
  for (const Trial& trial : session_.trials) {
    if (trial.kind == TrialKind::kMotion) trials.push_back(&trial);
  }
  return trials;
}

void Pipeline::time_stage(const std::string& name, double seconds) {
  report_.timings.push_back({name, seconds});
}

Status Pipeline::track() {
  const Stopwatch watch;
  for (const Trial& trial : session_.trials) {
    if (const Status ok = track_trial(trial); !ok) return ok;
  }
  time_stage("tags", watch.seconds());
  return Done{};
}

Status Pipeline::track_trial(const Trial& trial) {
  if (detections_.contains(trial.name)) return Done{};
  const auto folder = options_.out / trial.name / "detections";
  std::vector<CameraDetections> found(session_.cameras.size());
  for (std::size_t c = 0; c < found.size(); ++c) {
    found[c].camera = CameraId{static_cast<int>(c)};
  }
  std::vector<capture::CameraInput> missing;
  std::map<CameraId, std::string> keys;
  for (const TrialVideo& video : trial.videos) {
    const auto key = cache_key(video, trial, session_.tag_family);
    if (!key) return key.error();
    keys[video.camera] = *key;
    const auto file = folder / (session_.cameras[index(video.camera)] + ".csv");
    auto cached = recordings::read_detections(file, *key);
    // A cache that cannot be read is a cache that must be made again.
    if (cached && *cached) {
      found[index(video.camera)] = std::move(**cached);
      continue;
    }
    capture::CameraInput input;
    input.path = video.path;
    input.camera = video.camera;
    if (trial.frames) input.range = {trial.frames->first, trial.frames->last};
    input.rate = trial.rate;
    missing.push_back(std::move(input));
  }
  if (!missing.empty()) {
    capture::DetectVideosOptions detector;
    detector.detector.family = session_.tag_family;
    auto made = capture::detect_tags_in_videos(
        missing, detector, console_->stage("tags in " + trial.name));
    if (!made) return made.error();
    for (CameraDetections& camera : *made) {
      const auto file = folder / (session_.cameras[index(camera.camera)] + ".csv");
      const Status written =
          recordings::write_detections(file, camera, keys[camera.camera]);
      if (!written) return written;
      found[index(camera.camera)] = std::move(camera);
    }
  }
  for (const TrialVideo& video : trial.videos) {
    CameraDetections& camera = found[index(video.camera)];
    camera.camera = video.camera;
    camera.source = video.path.string();
    camera.offset = video.offset.value_or(Timestamp{0});
    if (trial.rate) camera.rate = *trial.rate;
    if (const Status ok = check_seen(camera); !ok) return ok;
  }
  if (const Status ok = check_rates(session_, trial, found); !ok) return ok;
  detections_[trial.name] = std::move(found);
  return Done{};
}

Result<std::vector<CameraDetections>> Pipeline::detections_of(const Trial& trial) {
  if (const Status ok = track_trial(trial); !ok) return ok.error();
  return detections_.at(trial.name);
}

Result<std::vector<CameraDetections>> Pipeline::unshrunk_detections_of(
    const Trial& trial) {
  auto detections = detections_of(trial);
  if (!detections) return detections.error();
  for (CameraDetections& camera : *detections) {
    const TagShrinkage& shrinkage = cameras_[index(camera.camera)].tag_shrinkage;
    for (FrameDetections& frame : camera.frames) {
      for (TagDetection& tag : frame.tags) {
        tag.corners_px = unshrunk(tag.corners_px, shrinkage);
      }
    }
  }
  return detections;
}

Status Pipeline::calibrate() {
  const Trial* waved_trial = session_.find(TrialKind::kCalibration);
  const Trial* floor_trial = session_.find(TrialKind::kFloor);
  if (!waved_trial) return missing_trial(session_, TrialKind::kCalibration);
  if (!floor_trial) return missing_trial(session_, TrialKind::kFloor);
  const auto waved = detections_of(*waved_trial);
  if (!waved) return waved.error();
  const auto floor = detections_of(*floor_trial);
  if (!floor) return floor.error();
  for (const CameraDetections& camera : *waved) {
    if (!camera.frames.empty()) continue;
    return bad_input(
        session_.file.string(),
        "camera \"" + session_.cameras[index(camera.camera)] +
            "\" has no video in trial \"" + waved_trial->name + "\"",
        "every camera must see the calibration board: add its video, or take the camera "
        "out of the session");
  }
  const Stopwatch watch;
  const Progress progress = console_->stage("cameras");
  progress(0, 1);
  const auto rig =
      calib::calibrate_cameras(session_.cameras, *waved, *floor, session_.board);
  if (!rig) return at(session_.file.string(), rig.error());
  progress(1, 1);
  cameras_ = rig->cameras;
  recordings::Calibration calibration;
  calibration.cameras = rig->cameras;
  calibration.rms_px = rig->rms_px;
  report_.calibration_rms_px = rig->rms_px;
  for (std::size_t c = 0; c < rig->cameras.size(); ++c) {
    const calib::CameraQuality& q = rig->quality[c];
    recordings::CameraRecord record;
    record.rms_px = q.rms_px;
    record.p95_px = q.p95_px;
    // Their last digits depend on how the linear algebra library orders its work.
    record.centre_sigma_m = rounded(q.centre_sigma_m, 6);
    record.focal_sigma_px = rounded(q.focal_sigma_px, 4);
    record.views = q.views;
    record.corners = q.corners;
    record.coverage = q.coverage;
    calibration.records.push_back(record);
  }
  time_stage("cameras", watch.seconds());
  return recordings::write_calibration(options_.out / "calibration.toml", calibration);
}

Status Pipeline::need_cameras() {
  const auto file = options_.out / "calibration.toml";
  const auto calibration = recordings::read_calibration(file);
  if (!calibration) {
    Error error = calibration.error();
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      error.next = "run marey calibrate on this session first, with the same --out";
    }
    return error;
  }
  report_.calibration_rms_px = calibration->rms_px;
  report_.cameras.clear();
  for (std::size_t c = 0; c < calibration->cameras.size(); ++c) {
    const recordings::CameraRecord& r = calibration->records[c];
    report_.cameras.push_back({calibration->cameras[c],
                               r.rms_px,
                               r.p95_px,
                               r.centre_sigma_m,
                               r.focal_sigma_px,
                               r.coverage,
                               r.views});
  }
  cameras_.clear();
  for (const std::string& name : session_.cameras) {
    const auto found = std::find_if(calibration->cameras.begin(),
                                    calibration->cameras.end(),
                                    [&](const Camera& c) { return c.name == name; });
    if (found == calibration->cameras.end()) {
      return bad_input(file.string(),
                       "camera \"" + name + "\" of the session is not in it",
                       "run marey calibrate on this session again");
    }
    cameras_.push_back(*found);
  }
  return Done{};
}

Status Pipeline::check_trials() {
  for (const Trial& trial : session_.trials) {
    if (trial.kind == TrialKind::kCalibration || trial.kind == TrialKind::kFloor)
      continue;
    const auto detections = unshrunk_detections_of(trial);
    if (!detections) return detections.error();
    const Status ok = reconstruct::check_views(cameras_, *detections, session_.tags);
    if (!ok) return at(session_.file.string(), ok.error());
  }
  return Done{};
}

Status Pipeline::fit() {
  if (const Status ok = need_cameras(); !ok) return ok;
  const Trial* standing_trial = session_.find(TrialKind::kStatic);
  const Trial* moving_trial = session_.find(TrialKind::kRangeOfMotion);
  if (!standing_trial) return missing_trial(session_, TrialKind::kStatic);
  if (!moving_trial) return missing_trial(session_, TrialKind::kRangeOfMotion);
  const auto standing = unshrunk_detections_of(*standing_trial);
  if (!standing) return standing.error();
  const auto moving = unshrunk_detections_of(*moving_trial);
  if (!moving) return moving.error();
  // Every trial, before the long work: who swapped two videos wants to know now.
  if (const Status ok = check_trials(); !ok) return ok;
  const Stopwatch watch;
  const reconstruct::SubjectPrior prior{session_.subject.name,
                                        session_.subject.stature_m,
                                        session_.subject.mass_kg,
                                        session_.tags};
  const auto fit = reconstruct::fit_subject(
      prior, cameras_, *standing, *moving, console_->stage("subject"));
  if (!fit) return at(session_.file.string(), fit.error());
  body_ = fit->body;
  report_.subject_rms_px = fit->rms_px;
  report_.limb_ratio = fit->limb_ratio;
  for (const TagId id : fit->unplaced) {
    report_.unplaced_tags.push_back(number(id));
    report_.warnings.push_back(
        "tag " + std::to_string(number(id)) +
        " was never seen well enough to be placed: it is not used");
  }
  time_stage("subject", watch.seconds());
  return recordings::write_subject(options_.out / "subject.toml", *body_);
}

Status Pipeline::need_body() {
  if (const Status ok = need_cameras(); !ok) return ok;
  // Read back even when this run wrote it: a stage sees the same numbers either way.
  auto body = recordings::read_subject(options_.out / "subject.toml");
  if (!body) return body.error();
  body_ = std::move(*body);
  report_.subject = *body_;
  return Done{};
}

Result<reconstruct::SolvedTrial> Pipeline::solve_trial(const Trial& trial,
                                                       const Progress& progress) {
  const auto detections = unshrunk_detections_of(trial);
  if (!detections) return detections.error();
  // A camera without a video in this trial keeps its place, and stays silent.
  auto solved = reconstruct::solve_motion(*body_, cameras_, *detections, {}, progress);
  if (!solved) return at(trial.name, solved.error());
  return solved;
}

Status Pipeline::solve() {
  if (const Status ok = need_body(); !ok) return ok;
  const std::vector<const Trial*> trials = motion_trials();
  if (trials.empty()) return missing_trial(session_, TrialKind::kMotion);
  for (const Trial* trial : trials) {
    if (const Status ok = track_trial(*trial); !ok) return ok;
  }
  const Stopwatch watch;
  std::vector<std::optional<Result<reconstruct::SolvedTrial>>> results(trials.size());
  in_parallel(trials.size(), [&](std::size_t i) {
    results[i] = solve_trial(*trials[i], console_->stage("motion of " + trials[i]->name));
  });
  time_stage("motion", watch.seconds());
  const Stopwatch writing;
  motions_.clear();
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!*results[i]) return results[i]->error();
    motions_.push_back({trials[i], std::move(**results[i]), {}});
    if (const Status ok = export_trial(motions_.back()); !ok) return ok;
  }
  time_stage("files", writing.seconds());
  return Done{};
}

Status Pipeline::export_trial(const SolvedMotion& motion) {
  const auto folder = options_.out / motion.trial->name;
  const EstimatedMotion& estimate = motion.solved.estimate;
  if (const Status ok = recordings::write_joints_csv(folder / "joints.csv", estimate);
      !ok) {
    return ok;
  }
  if (const Status ok = recordings::write_segments_csv(folder / "segments.csv", estimate);
      !ok) {
    return ok;
  }
  if (const Status ok = recordings::write_bvh(folder / "motion.bvh", estimate.motion);
      !ok) {
    return ok;
  }
  return recordings::write_character(folder / "motion.glb",
                                     estimate.motion.skeleton,
                                     recordings::make_mannequin_mesh(body_->proportions),
                                     &estimate.motion);
}

Status Pipeline::retarget() {
  const Stopwatch watch;
  for (SolvedMotion& motion : motions_) {
    for (const auto& avatar : options_.avatars) {
      auto body = retarget_one(motion, avatar);
      if (!body) return body.error();
      motion.avatars.push_back(std::move(*body));
    }
  }
  if (!options_.avatars.empty()) time_stage("avatars", watch.seconds());
  return Done{};
}

Result<ReportBody> Pipeline::retarget_one(SolvedMotion& motion,
                                          const std::filesystem::path& avatar) {
  const std::string name = avatar.stem().string();
  const std::filesystem::path folder = motion.trial->name;
  const auto written = retarget_to_files(
      motion.solved.estimate.motion, avatar, options_.out / folder / name);
  if (!written) return written.error();
  ReportBody body;
  body.name = name;
  body.motion = written->retargeted.motion;
  body.slide_before_cm_per_s = written->retargeted.report.before.mean_slide_cm_per_s;
  body.slide_after_cm_per_s = written->retargeted.report.after.mean_slide_cm_per_s;
  body.penetration_mm = written->retargeted.report.after.deepest_penetration_mm;
  for (const auto& file : written->files) {
    body.files.push_back((folder / file.filename()).string());
  }
  return body;
}

Result<ReportTrial> Pipeline::report_trial(const SolvedMotion& motion) {
  const auto detections = unshrunk_detections_of(*motion.trial);
  if (!detections) return detections.error();
  const reconstruct::SolvedTrial& solved = motion.solved;
  const Motion& poses = solved.estimate.motion;
  ReportTrial out;
  out.name = motion.trial->name;
  out.rate = poses.rate;
  out.first_frame = poses.first_frame;
  out.frames = static_cast<int>(poses.poses.size());
  out.frames_solved = solved.frames_solved;
  out.rms_px = solved.rms_px;
  out.median_px = solved.median_px;
  out.frame_rms_px = solved.frame_rms_px;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const reconstruct::CameraFit& fit = solved.cameras[c];
    out.cameras.push_back({cameras_[c].name,
                           fit.rms_px,
                           fit.median_px,
                           fit.corners,
                           fit.offset_s,
                           fit.offset_is_given});
  }
  for (const reconstruct::Gap& gap : solved.gaps) {
    out.gaps.push_back({std::string(name(gap.segment)),
                        gap.first_frame,
                        gap.last_frame,
                        gap.bridged_as});
  }
  out.tags = tags_over_time(session_.tags, *detections, poses);
  auto pictures = draw_frames(*motion.trial, cameras_, *detections, solved.estimate);
  if (!pictures) return pictures.error();
  out.pictures = std::move(*pictures);
  out.bodies.push_back({"subject", poses, solved.estimate.doubt, 0, 0, 0, {}});
  for (const char* file : {"motion.bvh", "motion.glb", "joints.csv", "segments.csv"}) {
    out.bodies.front().files.push_back(motion.trial->name + "/" + file);
  }
  out.bodies.insert(out.bodies.end(), motion.avatars.begin(), motion.avatars.end());
  return out;
}

Status Pipeline::write_report() {
  const Stopwatch watch;
  report_.trials.clear();
  for (const SolvedMotion& motion : motions_) {
    auto trial = report_trial(motion);
    if (!trial) return trial.error();
    report_.trials.push_back(std::move(*trial));
  }
  report_.recorded_s = 0.0;
  for (const auto& [name, cameras] : detections_) {
    double longest_s = 0.0;
    for (const CameraDetections& camera : cameras) {
      longest_s =
          std::max(longest_s, static_cast<double>(camera.frames.size()) / camera.rate.hz);
    }
    report_.recorded_s += longest_s;
  }
  time_stage("report", watch.seconds());
  if (const Status ok =
          recordings::write_file(options_.out / "report.json", report_json(report_));
      !ok) {
    return ok;
  }
  return recordings::write_file(options_.out / "report.html", report_html(report_));
}

}  // namespace marey::app

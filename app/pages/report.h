// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/camera_quality.h"
#include "core/detection.h"
#include "core/motion.h"
#include "core/provenance.h"

namespace marey::app {

/// One camera as the calibration left it.
struct ReportCamera {
  Camera camera;
  CameraQuality quality;
};

/// Reprojection of a solved trial in one camera.
struct ReportTrialCamera {
  std::string name;
  double rms_px = 0.0;
  double median_px = 0.0;
  int corners = 0;
  double offset_s = 0.0;
  ClockSource clock = ClockSource::kEstimated;
  DroppedSightings dropped;
};

/// A run of frames without a sight of a segment, and what became of it.
struct ReportGap {
  std::string segment;
  int first_frame = 0;
  int last_frame = 0;
  Source bridged_as = Source::kRepaired;
};

/// When one tag was seen.
struct ReportTag {
  int id = 0;
  std::string segment;
  std::vector<int> cameras_seeing;  ///< Per frame: how many cameras saw it.
  /// Distance of the solved motion from the tag's corners: root mean square and median.
  /// nullopt: the tag is not placed on the body or was not seen.
  std::optional<double> rms_px = std::nullopt;
  std::optional<double> median_px = std::nullopt;
  int corners = 0;
};

/// A video frame with the solved skeleton and the detected tags drawn over it. Lines and
/// outlines are in the picture's own pixels.
struct ReportPicture {
  std::string camera;
  int frame = 0;
  int width_px = 0;
  int height_px = 0;
  std::string jpeg;  ///< A whole JPEG file.
  struct Bone {
    glm::dvec2 from_px{0.0};
    glm::dvec2 to_px{0.0};
    Source source = Source::kMeasured;
  };
  std::vector<Bone> bones;
  struct Tag {
    int id = 0;
    std::vector<glm::dvec2> corners_px;  ///< Four.
  };
  std::vector<Tag> tags;
};

/// A body in motion, for the page's viewer.
struct ReportBody {
  std::string name;  ///< "subject", or the avatar's.
  Motion motion;
  std::vector<std::vector<JointUncertainty>>
      uncertainty;  ///< Per frame and joint; empty on avatars.
  // Of avatars only.
  double slide_before_cm_per_s = 0.0;
  double slide_after_cm_per_s = 0.0;
  double penetration_mm = 0.0;   ///< Of its skin; of its feet's ends without one.
  std::string penetration_part;  ///< Of the skin; empty: unknown, or none is too low.
  int penetration_frame = -1;    ///< Likewise; counted from the motion's first frame.
  double source_depth_mm = 0.0;  ///< How far the subject's joints are below the floor.
  double legs_deg = 0.0;         ///< From the subject's: the largest median of a segment.
  double arms_deg = 0.0;
  double trunk_deg = 0.0;
  std::vector<std::string> problems;
  std::vector<std::string> files;  ///< Written for it, relative to the report.
};

struct ReportTrial {
  std::string name;
  FrameRate rate;
  int first_frame = 0;
  int frames = 0;
  int frames_solved = 0;
  double rms_px = 0.0;
  double median_px = 0.0;
  std::vector<ReportTrialCamera> cameras;
  std::vector<double> frame_rms_px;  ///< Per frame.
  std::vector<ReportTag> tags;
  std::vector<ReportGap> gaps;
  std::vector<ReportPicture> pictures;
  std::vector<ReportBody> bodies;  ///< The subject first.
};

struct ReportTiming {
  std::string stage;
  double seconds = 0.0;
};

/// All that the report says. Built by the pipeline, written by write_report().
struct Report {
  std::string session;
  std::string version;
  std::vector<ReportCamera> cameras;
  double calibration_rms_px = 0.0;
  /// This run calibrated them: it said what there is to say
  /// (calib/quality/check_calibration.h).
  bool cameras_are_judged = false;
  bool has_calibration_page = false;  ///< calibration.html lies beside the report.
  std::optional<Body> subject;        ///< Once it is measured.
  double subject_rms_px = 0.0;
  double limb_ratio = 0.0;  ///< Limb lengths over an average person's of that stature.
  std::vector<int> unplaced_tags;
  std::vector<ReportTrial> trials;
  std::vector<ReportTiming> timings;
  double recorded_s = 0.0;  ///< Duration of all trials together.
  std::vector<std::string> warnings;
  /// Those of them that are reasons not to trust the results: exit code 4.
  std::vector<std::string> poor;
};

/// The figures as JSON, without pictures and motions: report.json.
/// Precondition: every number finite.
[[nodiscard]] std::string report_json(const Report& report);

/// The whole report as one HTML file that needs nothing else: no network, no other file.
[[nodiscard]] std::string report_html(const Report& report);

}  // namespace marey::app

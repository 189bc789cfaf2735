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
#include "core/finding.h"
#include "core/motion.h"
#include "core/source.h"

namespace marey::app {

/// A camera, with the quality of its calibration.
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

/// Successive frames in which no tag of a segment is seen, and the source of its motion
/// there.
struct ReportGap {
  std::string segment;
  int first_frame = 0;
  int last_frame = 0;
  Source bridged_as = Source::kRepaired;
};

/// Frames in which one tag was seen.
struct ReportTag {
  int id = 0;
  std::string segment;
  std::vector<int> cameras_seeing;  ///< Per frame: cameras that saw the tag.
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
  std::string name;  ///< "subject", or the name of the avatar.
  Motion motion;
  std::vector<std::vector<JointUncertainty>>
      uncertainty;  ///< Per frame and joint; empty on avatars.
  // Avatars only.
  double slide_before_cm_per_s = 0.0;
  double slide_after_cm_per_s = 0.0;
  double penetration_mm = 0.0;   ///< Depth of the skin, else of the feet's ends.
  std::string penetration_part;  ///< Part of the skin; empty: none, or unknown.
  std::optional<int> penetration_frame{};  ///< Frame of it; 0 is the motion's first.
  double source_depth_mm = 0.0;  ///< Depth of the subject's joints below the floor.
  double legs_deg = 0.0;         ///< From the subject: largest median of a segment.
  double arms_deg = 0.0;
  double trunk_deg = 0.0;
  std::vector<Finding> problems;   ///< With the trial in `where`.
  std::vector<std::string> files;  ///< Files of this body, relative to the report.
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

/// Content of the report. Built by the pipeline, written by write_report().
struct Report {
  std::string session;
  std::string version;
  std::vector<ReportCamera> cameras;
  double calibration_rms_px = 0.0;
  /// True if this run calibrated the cameras, so that their findings are already reported
  /// (calib/quality/assess_calibration.h).
  bool cameras_are_assessed = false;
  bool has_calibration_page = false;  ///< calibration.html is next to the report.
  std::optional<Body> subject;        ///< nullopt before the fit.
  double subject_rms_px = 0.0;
  double limb_ratio = 0.0;  ///< Limb lengths over an average person's of that stature.
  std::vector<int> unplaced_tags;
  std::vector<ReportTrial> trials;
  std::vector<ReportTiming> timings;
  double recorded_s = 0.0;  ///< Duration of all trials together.
  /// Problems with which the run was completed. Poor ones determine the exit code.
  std::vector<Finding> findings;
};

/// Returns the figures as JSON, without pictures and motions: the content of report.json.
/// Precondition: all numbers are finite.
[[nodiscard]] std::string report_json_text(const Report& report);

/// Returns the report as one HTML file that loads no other file and needs no network.
[[nodiscard]] std::string report_html(const Report& report);

}  // namespace marey::app

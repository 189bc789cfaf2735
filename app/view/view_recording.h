// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/marker_tracks.h"
#include "core/motion.h"
#include "live/page/page_scene.h"
#include "retarget/balance/measure_balance.h"

namespace marey::app {

/// The glTF file with the skin of a figure.
struct FigureSkin {
  std::filesystem::path file;  ///< .glb or .vrm.
  std::vector<int> node_of_joint;
  double unit_from_m = 1.0;
  glm::dquat marey_from_file{1.0, 0.0, 0.0, 0.0};
};

/// A moving body. Its first frame is the first frame of the recording.
struct ViewedFigure {
  std::string name;
  live::PageSkeletonKind kind = live::PageSkeletonKind::kMotion;
  Motion motion;
  std::vector<std::vector<JointUncertainty>>
      uncertainty{};                              ///< [frame][joint], or empty.
  std::vector<retarget::BalanceFrame> balance{};  ///< [frame], or empty.
  std::optional<FigureSkin> skin{};
};

/// All data that `marey view` shows of a recording.
struct ViewedRecording {
  std::string title;
  FrameRate rate;
  int first_frame = 0;
  int frames = 1;
  std::vector<ViewedFigure> figures;
  std::optional<MarkerTracks> points;
  std::vector<live::PageCamera> cameras;
  std::vector<live::PageTrack> tracks;
  std::vector<live::PageContact> contacts;
  std::vector<live::PageGraph> graphs;
  std::vector<live::PageNote> notes;
  std::vector<std::string> remarks;  ///< Notes to the user of the command.
};

/// Adds a frame to the gaps of a track, unless it was measured. Frames must be in order.
inline void add_gap(live::PageTrack& track, int frame, Source source) {
  if (source == Source::kMeasured) return;
  auto& gaps = track.gaps;
  if (!gaps.empty() && gaps.back().source == source &&
      gaps.back().span.last == frame - 1) {
    gaps.back().span.last = frame;
  } else {
    gaps.push_back({{frame, frame}, source});
  }
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_live_take.h"

#include <algorithm>
#include <string>
#include <utility>

#include "app/live_chain/live_chain.h"
#include "app/live_chain/open_live_take.h"
#include "app/shell/inside_folder.h"
#include "app/shell/program_name.h"
#include "app/view/view_cameras.h"
#include "app/view/view_figure.h"
#include "recordings/takes/live_take.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxPause_s = 10.0;

fs::path folder_of(const fs::path& what) {
  return what.filename() == recordings::kLiveTakeFile ? what.parent_path() : what;
}

/// Collects the recomputed figures of a take.
class Remade {
 public:
  Remade(ViewedRecording& out, FrameRate rate)
      : out_(out), max_pause_(static_cast<std::int64_t>(kMaxPause_s * rate.hz)) {}

  void add(const LiveResult& result) {
    if (result.track.state == reconstruct::TrackState::kWaiting) return;
    ViewedFigure& performer = out_.figures.front();
    if (!performer.motion.poses.empty()) hold(result.number - last_number_ - 1);
    last_number_ = result.number;
    performer.motion.poses.push_back(*result.pose);
    performer.uncertainty.emplace_back(result.uncertainty.begin(),
                                       result.uncertainty.end());
    for (std::size_t a = 0; a < result.avatars.size(); ++a) {
      out_.figures[a + 1].motion.poses.push_back(result.avatars[a]);
    }
    out_.graphs.front().values.push_back(result.track.rms_px);
  }

  [[nodiscard]] bool left_out() const { return left_out_; }

 private:
  /// Repeats the last frame for instants that the run skipped.
  void hold(std::int64_t instants) {
    left_out_ |= instants > max_pause_;
    for (std::int64_t i = 0; i < std::min(instants, max_pause_); ++i) {
      for (ViewedFigure& figure : out_.figures) {
        figure.motion.poses.push_back(figure.motion.poses.back());
      }
      auto& uncertainty = out_.figures.front().uncertainty;
      uncertainty.push_back(uncertainty.back());
      for (JointUncertainty& joint : uncertainty.back()) {
        if (joint.source == Source::kMeasured) joint.source = Source::kRepaired;
      }
      out_.graphs.front().values.push_back(out_.graphs.front().values.back());
    }
  }

  ViewedRecording& out_;
  std::int64_t max_pause_;
  std::int64_t last_number_ = 0;
  bool left_out_ = false;
};

Status add_bodies(const OpenedTake& opened,
                  const Skeleton& performer,
                  ViewedRecording& out) {
  const FrameRate rate = opened.settings.rate;
  const std::string& name = opened.body.name;
  out.figures.push_back({name.empty() ? "performer" : name,
                         live::PageSkeletonKind::kPerformer,
                         Motion{performer, rate, 0, {}}});
  for (std::size_t a = 0; a < opened.avatars.size(); ++a) {
    const OpenedAvatar& avatar = opened.avatars[a];
    auto figure = figure_of_file(avatar.file, out.remarks);
    if (!figure) return figure.error();
    // The original name, because the file in the take is numbered.
    figure->name = fs::path(opened.settings.avatars[a]).stem().string();
    figure->kind = live::PageSkeletonKind::kAvatar;
    figure->motion = Motion{avatar.skeleton, rate, 0, {}};
    out.figures.push_back(*std::move(figure));
  }
  return Done{};
}

}  // namespace

bool is_live_take(const fs::path& what) {
  std::error_code ignored;
  return fs::is_regular_file(folder_of(what) / recordings::kLiveTakeFile, ignored);
}

Result<ViewedRecording> read_live_take_view(const fs::path& what) {
  const fs::path folder = folder_of(what);
  for (const fs::path& shown : {folder, folder / "avatars"}) {
    if (const Status ok = check_links(shown, folder); !ok) return ok.error();
  }
  const auto opened = open_live_take(folder);
  if (!opened) return opened.error();
  auto chain = LiveChain::make(
      opened->body, opened->calibration.cameras, opened->avatars, opened->settings);
  if (!chain) return chain.error();
  ViewedRecording out;
  out.title = fs::weakly_canonical(folder).filename().string();
  out.rate = opened->settings.rate;
  out.graphs.push_back({"reprojection", "px", {}});
  if (const Status ok = add_bodies(*opened, chain->performer(), out); !ok) {
    return ok.error();
  }
  Remade remade(out, out.rate);
  const std::string file = (folder / recordings::kLiveTakeFile).string();
  for (const recordings::LiveTakeInstant& one : opened->take.instants) {
    const auto requests = parse_live_requests(one.requests, file);
    if (!requests) return requests.error();
    const LiveResult& result = chain->step(one.seen, *requests);
    // An instant without results belongs to the lead-in of a take.
    if (!one.results.empty()) remade.add(result);
  }
  const ViewedFigure& performer = out.figures.front();
  if (performer.motion.poses.empty()) {
    return bad_input(
        folder.string(),
        "no body was found in any instant of this take",
        "check the cameras: " +
            shell_command({"marey", "view", (folder / "calibration.toml").string()}));
  }
  out.frames = static_cast<int>(performer.motion.poses.size());
  out.tracks = tracks_of(performer, 0);
  if (out.frames > 1) out.contacts = contact_spans(performer.motion, 0);
  auto cameras = page_cameras(folder / "calibration.toml");
  if (!cameras) return cameras.error();
  out.cameras = *std::move(cameras);
  if (!opened->take.finished) {
    out.remarks.push_back("the recording was cut off; the recorded part is shown");
  }
  if (remade.left_out()) {
    out.remarks.push_back("pauses of more than 10 s are shortened to 10 s");
  }
  return out;
}

}  // namespace marey::app

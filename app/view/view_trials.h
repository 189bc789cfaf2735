// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/view/view_files.h"
#include "app/view/view_handles.h"
#include "core/base/result.h"
#include "live/web/received_text.h"
#include "live/web/web_server.h"

namespace marey::app {

/// A served recording, with the handles that pages drag.
struct ViewedTrial {
  std::string name;  ///< Empty if it is not a trial.
  ViewedRecording recording;
  ViewHandles handles;
  std::string scene;  ///< In the format of the page.
};

/// Manages the recordings that `marey view` serves: a file, or the trials of a folder of
/// results. Reads the chosen trial first, and others when a page requests them. Each page
/// shows one trial. Served content stays available until the program ends, for slow
/// pages.
class ViewTrials {
 public:
  /// Reads the chosen trial, and the report of the folder if there is one. Errors: those
  /// of read_view(), page_of_recording() and ViewHandles::make().
  [[nodiscard]] static Result<ViewTrials> open(const ViewChoice& choice,
                                               const std::filesystem::path& constraints);

  static constexpr const char* kReport = "/report.html";

  /// Adds the media of the trials read so far to the server, and the report as kReport.
  void serve(live::WebServer& server);

  /// Returns the trial that a page shows.
  [[nodiscard]] ViewedTrial& seen_by(live::ClientId client);
  /// Switches a page to another trial and returns its scene.
  /// Errors (kBadInput), sent to the page: an unknown trial; those of open().
  [[nodiscard]] Result<std::string_view> show(live::ClientId client,
                                              const std::string& name,
                                              live::WebServer& server);
  [[nodiscard]] const ViewedTrial& first() const { return *trials_.front(); }

 private:
  ViewTrials() = default;
  [[nodiscard]] Result<ViewedTrial*> read(const std::string& name);

  ViewChoice choice_;
  std::filesystem::path constraints_;
  std::vector<std::string> names_;  ///< Names of all trials; empty: a single recording.
  std::optional<live::WebContent> report_;
  std::vector<std::unique_ptr<ViewedTrial>> trials_;  ///< Trials read so far.
  std::vector<live::WebContent> unserved_;
  std::size_t media_ = 0;  ///< Number of media.
  /// Pages that show another trial than the first; the kMaxPages latest ones.
  std::vector<std::pair<live::ClientId, ViewedTrial*>> seen_;
};

}  // namespace marey::app

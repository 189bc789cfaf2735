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

/// A recording that is served, and what pages do to it.
struct ViewedTrial {
  std::string name;  ///< Empty for what is no trial.
  ViewedRecording recording;
  ViewHandles handles;
  std::string scene;  ///< As pages take it.
};

/// What `marey view` serves of a file or of a folder of results: the trial that was asked
/// for, and the others once a page asks for them. Each page looks at one of them. What
/// was served stays so until the program ends: a page that is slow finds it.
class ViewTrials {
 public:
  /// Reads the first, and the report of the folder, if it has one. Errors: read_view()'s,
  /// page_of_recording()'s, ViewHandles::make()'s.
  [[nodiscard]] static Result<ViewTrials> open(const ViewChoice& choice,
                                               const std::filesystem::path& constraints);

  static constexpr const char* kReport = "/report.html";

  /// Puts on the server what trials need that were read, and the report as kReport.
  void serve(live::WebServer& server);

  /// The one that a page looks at.
  [[nodiscard]] ViewedTrial& seen_by(live::ClientId client);
  /// A page looks at another from now on; returns its scene.
  /// Errors (kBadInput), for the page: no such trial, or as open().
  [[nodiscard]] Result<std::string_view> show(live::ClientId client,
                                              const std::string& name,
                                              live::WebServer& server);
  [[nodiscard]] const ViewedTrial& first() const { return *trials_.front(); }

 private:
  ViewTrials() = default;
  [[nodiscard]] Result<ViewedTrial*> read(const std::string& name);

  ViewChoice choice_;
  std::filesystem::path constraints_;
  std::vector<std::string> names_;  ///< Of all trials; empty: there is but one thing.
  std::optional<live::WebContent> report_;
  std::vector<std::unique_ptr<ViewedTrial>> trials_;  ///< Those that were read.
  std::vector<live::WebContent> unserved_;
  std::size_t media_ = 0;  ///< How many there are.
  /// Who looks at another than the first; the last kMaxPages who asked.
  std::vector<std::pair<live::ClientId, ViewedTrial*>> seen_;
};

}  // namespace marey::app

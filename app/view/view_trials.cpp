// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_trials.h"

#include <algorithm>

#include "app/shell/inside_folder.h"
#include "app/view/view_page.h"
#include "app/view/view_trial.h"
#include "live/page/page_scene.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPages = 64;

/// Returns the folder of results that contains `what`; empty: none.
fs::path results_of(const fs::path& what) {
  std::error_code ignored;
  if (!fs::is_directory(what, ignored)) return {};
  const bool is_trial = fs::exists(what / "segments.csv", ignored);
  return is_trial ? fs::weakly_canonical(what, ignored).parent_path() : what;
}

/// Reads the report of `marey process` or `marey fit`: one file with an inline script
/// that may not load other content.
std::optional<live::WebContent> report_in(const fs::path& results) {
  std::error_code ignored;
  for (const char* name : {"report.html", "fit.html"}) {
    if (!fs::is_regular_file(results / name, ignored)) continue;
    if (!is_inside(results / name, results)) continue;
    auto content =
        file_content(results / name, ViewTrials::kReport, "text/html; charset=utf-8");
    if (!content) return std::nullopt;
    content->policy =
        "default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
        "script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'";
    return *std::move(content);
  }
  return std::nullopt;
}

}  // namespace

Result<ViewTrials> ViewTrials::open(const ViewChoice& choice,
                                    const fs::path& constraints) {
  ViewTrials out;
  out.choice_ = choice;
  out.constraints_ = constraints;
  if (const fs::path results = results_of(choice.what); !results.empty()) {
    out.names_ = solved_trials(results);
    out.report_ = report_in(results);
  }
  const auto first = out.read(choice.trial);
  if (!first) return first.error();
  if (!out.names_.empty()) {
    // Trials are named relative to the folder of results.
    out.choice_.what = results_of(choice.what);
  }
  return out;
}

/// Reads a trial. Adds it to `trials_`, and its media to `unserved_`.
Result<ViewedTrial*> ViewTrials::read(const std::string& name) {
  ViewChoice choice = choice_;
  choice.trial = name;
  auto recording = read_view(choice);
  if (!recording) return recording.error();
  auto page = page_of_recording(*recording, media_ + 1);
  if (!page) return page.error();
  auto handles = ViewHandles::make(*recording, constraints_);
  if (!handles) return handles.error();
  page->scene.constraints = handles->constraints();
  const bool is_trial = std::ranges::find(names_, recording->title) != names_.end();
  std::string trial = is_trial ? recording->title : std::string();
  if (page->scene.file) {
    page->scene.file->trial = trial;
    page->scene.file->trials = names_;
    if (report_) page->scene.file->report = kReport;
  }
  media_ += page->media.size();
  std::ranges::move(page->media, std::back_inserter(unserved_));
  trials_.push_back(std::make_unique<ViewedTrial>(
      ViewedTrial{std::move(trial), *std::move(recording), *std::move(handles), {}}));
  trials_.back()->scene = live::scene_json(page->scene);
  return trials_.back().get();
}

void ViewTrials::serve(live::WebServer& server) {
  if (report_) server.put(*report_);
  for (live::WebContent& content : unserved_) server.put(std::move(content));
  unserved_.clear();
}

ViewedTrial& ViewTrials::seen_by(live::ClientId client) {
  const auto found =
      std::ranges::find(seen_, client, &std::pair<live::ClientId, ViewedTrial*>::first);
  return found == seen_.end() ? *trials_.front() : *found->second;
}

Result<std::string_view> ViewTrials::show(live::ClientId client,
                                          const std::string& name,
                                          live::WebServer& server) {
  if (std::ranges::find(names_, name) == names_.end()) {
    return bad_input("trial", "there is no \"" + name + "\" here", "choose another");
  }
  const auto known = std::ranges::find_if(
      trials_, [&name](const auto& trial) { return trial->name == name; });
  ViewedTrial* trial = known == trials_.end() ? nullptr : known->get();
  if (trial == nullptr) {
    const auto read_now = read(name);
    if (!read_now) return read_now.error();
    trial = *read_now;
    serve(server);
  }
  std::erase_if(seen_, [client](const auto& one) { return one.first == client; });
  if (seen_.size() == kMaxPages) seen_.erase(seen_.begin());
  seen_.emplace_back(client, trial);
  return std::string_view(trial->scene);
}

}  // namespace marey::app

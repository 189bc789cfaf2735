// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live_chain/live_settings.h"
#include "app/live_chain/live_streams.h"
#include "app/live_chain/subject_wizard.h"
#include "app/motion/retarget_files.h"
#include "app/shell/console.h"
#include "app/view/page_server.h"
#include "capture/feeds/frame_feed.h"
#include "capture/feeds/video_feed.h"
#include "capture/tags/detect_tags.h"
#include "core/base/result.h"
#include "core/body.h"
#include "reconstruct/subject/fit_subject.h"
#include "recordings/session/calibration_file.h"

namespace marey::app {

/// Arguments of `marey live`.
struct LiveArguments {
  std::filesystem::path session;  ///< session.toml or its folder.
  /// The folder with calibration.toml and subject.toml; empty: the session's.
  std::filesystem::path results;
  /// Trials whose videos are the cameras, one after the other; empty: real cameras.
  std::vector<std::string> play;
  bool loop = false;
  std::vector<std::string> cameras;  ///< Names of the cameras to use; empty: all.
  std::optional<std::filesystem::path> media;
  std::vector<std::filesystem::path> avatars;
  std::vector<std::string> vmc;  ///< "[AVATAR=]HOST[:PORT]".
  std::string vmc_rest = "vrm0";
  std::optional<int> vmc_mtu;       ///< nullopt: by the target; 0: one bundle a frame.
  std::optional<int> vmc_listen;    ///< nullopt: VMC's own port, if it is free.
  bool vmc_send_only = false;       ///< Receives no VMC commands.
  std::vector<std::string> vrchat;  ///< "HOST[:PORT]".
  std::string balance = "off";      ///< "off" or "preview".
  std::filesystem::path record;     ///< Folder of the take; empty: not recorded.
  std::optional<double> seconds;
  double wait_ms = 50.0;
  bool no_page = false;
  PageServerOptions page;
  bool json = false;
  bool calibrate = false;  ///< Measures the subject first, or again.
  WizardOptions wizard;
};

/// A live run before its first frame.
struct OpenedLive {
  std::string session;
  std::filesystem::path folder;         ///< The session's.
  recordings::Calibration calibration;  ///< Cameras in use, in their order.
  std::optional<Body> body;             ///< nullopt: not measured yet.
  reconstruct::SubjectPrior prior;      ///< Prior of the subject to be measured, if any.
  std::filesystem::path subject_file;
  std::vector<OpenedAvatar> avatars;
  LiveSettings settings;
  std::vector<StreamTargets> targets;  ///< By stream.
  std::vector<live::UdpAddress> vrchat;
  std::vector<std::unique_ptr<capture::FrameFeed>> feeds;
  std::vector<capture::VideoFeed*> videos;  ///< Video feeds that must be started.
  capture::TagDetectorOptions detector;
};

/// Reads and opens all inputs of a live run, the cameras last.
///
/// Errors (kBadInput): those of the session; the calibration is missing, or the subject
/// is missing and is not to be measured (the message names the command that creates
/// them); the session does not describe the subject to be measured; a camera is missing
/// in the calibration or has another picture size; fewer than two cameras can be used; an
/// avatar is not humanoid; an address is invalid. (kDevice): a camera cannot be opened.
[[nodiscard]] Result<OpenedLive> open_live(const LiveArguments& arguments,
                                           Console& console);

}  // namespace marey::app

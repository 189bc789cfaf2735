// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/sessions/session_mistakes.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <variant>

namespace marey::benchmarks {
namespace {

using Bones = std::vector<HumanBone>;
using Mistakes = std::vector<SessionMistake>;
using B = HumanBone;

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

auto exchange_sides(Bones bones) {
  return [bones](PlainSession& session) {
    for (PlainSession::Tag& tag : session.tags) {
      const bool is_meant =
          bones.empty() || std::count(bones.begin(), bones.end(), tag.segment) > 0 ||
          std::count(bones.begin(), bones.end(), mirrored(tag.segment)) > 0;
      if (is_meant) tag.segment = mirrored(tag.segment);
    }
  };
}

auto exchange_segments(HumanBone a, HumanBone b) {
  return [a, b](PlainSession& session) {
    for (PlainSession::Tag& tag : session.tags) {
      if (tag.segment == a) {
        tag.segment = b;
      } else if (tag.segment == b) {
        tag.segment = a;
      }
    }
  };
}

auto exchange_videos(std::string a, std::string b) {
  return [a, b](PlainSession& session) {
    std::swap(session.of_kind(a).videos, session.of_kind(b).videos);
  };
}

auto scale_tags(double factor) {
  return [factor](PlainSession& session) {
    for (PlainSession::Tag& tag : session.tags) tag.size_m *= factor;
  };
}

auto omit_trial(std::string kind) {
  return [kind](PlainSession& session) {
    std::erase_if(session.trials, [&](const auto& trial) { return trial.kind == kind; });
  };
}

auto add_to(std::string kind, std::string extra) {
  return [kind, extra](PlainSession& session) {
    for (PlainSession::Trial& trial : session.trials) {
      if (trial.kind == kind) trial.extra = extra;
    }
  };
}

const std::vector<std::string> kExchange{"exchang", "swap"};

void add_exchanges_of_sides(Mistakes& out) {
  out.push_back({"sides", exchange_sides({}), {kExchange, {"left"}, {"right"}}});
  out.push_back({"legs",
                 exchange_sides({B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot}),
                 {kExchange, {"legs", "UpperLeg"}}});
  out.push_back({"arms",
                 exchange_sides({B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand}),
                 {kExchange, {"arms", "UpperArm"}}});
  for (const auto& [word, bone] : {std::pair("upper-arms", B::kLeftUpperArm),
                                   std::pair("forearms", B::kLeftLowerArm),
                                   std::pair("hands", B::kLeftHand),
                                   std::pair("thighs", B::kLeftUpperLeg),
                                   std::pair("shins", B::kLeftLowerLeg),
                                   std::pair("feet", B::kLeftFoot)}) {
    out.push_back(
        {word,
         exchange_sides({bone}),
         {kExchange, {std::string(name(bone))}, {std::string(name(mirrored(bone)))}}});
  }
}

void add_exchanges_of_segments(const PlainSession& right, Mistakes& out) {
  for (const auto& [a, b] : {std::pair(B::kHips, B::kUpperChest),
                             std::pair(B::kUpperChest, B::kHead),
                             std::pair(B::kLeftUpperArm, B::kLeftLowerArm),
                             std::pair(B::kRightUpperLeg, B::kRightLowerLeg)}) {
    out.push_back({std::string(name(a)).append("-").append(name(b)),
                   exchange_segments(a, b),
                   {{std::string(name(a))}, {std::string(name(b))}}});
  }
  const std::vector<int> hips = right.ids_on(B::kHips);
  const std::vector<int> thigh = right.ids_on(B::kLeftUpperLeg);
  const std::vector<int> forearm = right.ids_on(B::kLeftLowerArm);
  const auto words = [](int id) { return std::vector{std::to_string(id)}; };
  out.push_back({"two-hip-ids-of-thighs",
                 [=](PlainSession& session) {
                   session.tag(hips[0]).segment = B::kLeftUpperLeg;
                   session.tag(hips[1]).segment = B::kLeftUpperLeg;
                   session.tag(thigh[0]).segment = B::kHips;
                   session.tag(thigh[1]).segment = B::kHips;
                 },
                 {{std::to_string(hips[0]), "UpperLeg"}, {"hips"}}});
  out.push_back({"two-hip-ids-nowhere",
                 [=](PlainSession& session) {
                   session.tag(hips[0]).id = 500;
                   session.tag(hips[1]).id = 501;
                 },
                 {{"500"}, {"501"}, words(hips[0]), words(hips[1])}});
  out.push_back({"one-id-nowhere",
                 [=](PlainSession& session) { session.tag(forearm[0]).id = 502; },
                 {{"502"}, words(forearm[0])}});
  out.push_back(
      {"hip-id-on-chest",
       [=](PlainSession& session) { session.tag(hips[0]).segment = B::kUpperChest; },
       {words(hips[0])}});
  out.push_back({"foot-id-on-other-foot",
                 [=](PlainSession& session) {
                   for (PlainSession::Tag& tag : session.tags) {
                     if (tag.segment == B::kLeftFoot) tag.segment = B::kRightFoot;
                   }
                 },
                 {words(right.ids_on(B::kLeftFoot)[0])}});
  out.push_back({"id-twice",
                 [=](PlainSession& session) { session.tag(thigh[1]).id = thigh[0]; },
                 {words(thigh[0])},
                 true});
}

void add_exchanges_of_videos(const PlainSession& right, Mistakes& out) {
  out.push_back({"static-rom",
                 exchange_videos("static", "range-of-motion"),
                 {{"static"}, {"and rom", "trial rom"}}});
  out.push_back({"static-walk", exchange_videos("static", "motion"), {{"static"}}});
  out.push_back({"static-walks-too",
                 [](PlainSession& session) {
                   session.of_kind("static").videos = session.of_kind("motion").videos;
                 },
                 {{"static"}}});
  out.push_back({"rom-walk",
                 exchange_videos("range-of-motion", "motion"),
                 {{"trial rom", "range of motion"}}});
  out.push_back({"calib-walk", exchange_videos("calibration", "motion"), {{"calib"}}});
  for (const std::string kind : {"motion", "static", "calibration"}) {
    out.push_back({"cameras-of-" + kind,
                   [=](PlainSession& session) {
                     auto& videos = session.of_kind(kind).videos;
                     std::swap(videos[0].second, videos[1].second);
                   },
                   {kExchange, {right.cameras[0]}, {right.cameras[1]}}});
  }
  out.push_back({"trials-reversed",
                 [](PlainSession& session) {
                   std::reverse(session.trials.begin(), session.trials.end());
                 },
                 {},
                 false,
                 true});
}

void add_scales(const PlainSession& right, Mistakes& out) {
  for (const auto& [word, stature_m] :
       {std::pair("stature+0.30", right.stature_m + 0.3),
        std::pair("stature-0.30", right.stature_m - 0.3),
        std::pair("stature-cm", 100 * right.stature_m),
        std::pair("stature-in", right.stature_m / 0.0254),
        std::pair("stature-ft", right.stature_m / 0.3048)}) {
    out.push_back({word,
                   [=, m = stature_m](PlainSession& session) { session.stature_m = m; },
                   {{"stature_m"}},
                   stature_m > 2.8});
  }
  out.push_back({"tags-x2", scale_tags(2.0), {{"size_m"}}});
  out.push_back({"tags-10%", scale_tags(0.9), {{"size_m"}}});
  out.push_back({"tags-mm", scale_tags(1000.0), {{"size_m"}}, true});
  const int shin = right.ids_on(B::kLeftLowerLeg)[0];
  out.push_back({"one-tag-10%",
                 [=](PlainSession& session) { session.tag(shin).size_m *= 0.9; },
                 {{"size_m"}, {std::to_string(shin)}}});
  out.push_back({"board-10%",
                 [](PlainSession& session) {
                   session.board.tag_size_m *= 0.9;
                   session.board.gap_m *= 0.9;
                 },
                 {{"[board]", "tag_size_m"}}});
  out.push_back({"board-gap",
                 [](PlainSession& session) { session.board.gap_m *= 0.5; },
                 {{"[board]", "gap_m"}}});
  for (const auto& [word, kind, fps] :
       {std::tuple("fps-60", "motion", "60.0"),
        std::tuple("fps-25", "motion", "25.0"),
        std::tuple("fps-60-rom", "range-of-motion", "60.0"),
        std::tuple("fps-25-calib", "calibration", "25.0")}) {
    out.push_back({word, add_to(kind, std::string("fps = ").append(fps)), {{"fps"}}});
  }
}

void add_renames_and_omissions(const PlainSession& right, Mistakes& out) {
  out.push_back({"family",
                 [](PlainSession& session) { session.family = "tag25h9"; },
                 {{"family", "tag25h9"}},
                 true});
  out.push_back({"family-36h10",
                 [](PlainSession& session) { session.family = "tag36h10"; },
                 {{"tag36h11", "36h11"}}});
  out.push_back({"board-first-id",
                 [](PlainSession& session) { session.board.first_id = 200; },
                 {{"first_id"}}});
  out.push_back(
      {"board-rows", [](PlainSession& session) { session.board.rows -= 1; }, {{"rows"}}});
  out.push_back({"floor-while-waved",
                 add_to("floor", "fps = 10.0\nframes = [60, 67]"),
                 {{"floor"}, {"frames"}}});
  out.push_back({"forearm-without-tags",
                 [](PlainSession& session) {
                   std::erase_if(session.tags, [](const auto& tag) {
                     return tag.segment == B::kLeftLowerArm;
                   });
                 },
                 {{"leftLowerArm"}},
                 true});
  out.push_back({"no-static", omit_trial("static"), {{"static"}}, true});
  out.push_back({"no-rom", omit_trial("range-of-motion"), {{"range-of-motion"}}, true});
  out.push_back({"file-missing",
                 [](PlainSession& session) {
                   session.of_kind("static").videos[1].second = "static/cam9.mp4";
                 },
                 {{"static/cam9.mp4"}},
                 true});
  out.push_back(
      {"camera-not-in-walk",
       [](PlainSession& session) { session.of_kind("motion").videos.pop_back(); },
       {},
       false,
       true});
  out.push_back(
      {"camera-not-in-calib",
       [](PlainSession& session) { session.of_kind("calibration").videos.pop_back(); },
       {{right.cameras.back()}, {"calib"}},
       true});
}

/// Clocks, floors and single tags: mistakes that once ended with exit code 0.
void add_once_silent(const PlainSession& right, Mistakes& out) {
  out.push_back({"offset-25ms",
                 add_to("motion",
                        "time_offset_s = { " + right.cameras[0] + " = 0.0, " +
                            right.cameras[1] + " = 0.025 }"),
                 {{"time_offset_s"}, {right.cameras[1]}}});
  out.push_back({"board-thickness",
                 [](PlainSession& session) { session.board.thickness_m += 0.095; },
                 {{"thickness_m"}}});
  const int foot = right.ids_on(B::kLeftFoot)[0];
  out.push_back(
      {"foot-id-on-shin",
       [=](PlainSession& session) { session.tag(foot).segment = B::kLeftLowerLeg; },
       {{std::to_string(foot)}, {"leftFoot"}}});
  const int hips = right.ids_on(B::kHips)[0];
  const int shin = right.ids_on(B::kRightLowerLeg)[0];
  out.push_back({"hip-and-shin-ids",
                 [=](PlainSession& session) {
                   std::swap(session.tag(hips).segment, session.tag(shin).segment);
                 },
                 {{std::to_string(hips)}, {std::to_string(shin)}}});
  out.push_back(
      {"frames-beyond", add_to("motion", "frames = [0, 9999]"), {{"frames"}}, true});
}

/// Sessions that are as good as the right one.
void add_harmless(const PlainSession& right, Mistakes& out) {
  const auto harmless = [&](std::string name, std::function<void(PlainSession&)> make) {
    out.push_back({std::move(name), std::move(make), {}, false, true});
  };
  harmless("stature+0.02", [](PlainSession& session) { session.stature_m += 0.02; });
  harmless("cameras-reversed", [](PlainSession& session) {
    std::reverse(session.cameras.begin(), session.cameras.end());
  });
  harmless("unlisted-hip-tag", [id = right.ids_on(B::kHips)[0]](PlainSession& session) {
    std::erase_if(session.tags, [&](const auto& tag) { return tag.id == id; });
  });
}

}  // namespace

PlainSession::Trial& PlainSession::of_kind(std::string_view kind) {
  for (Trial& trial : trials) {
    if (trial.kind == kind) return trial;
  }
  throw std::runtime_error("no trial of kind " + std::string(kind));
}

std::vector<int> PlainSession::ids_on(HumanBone segment) const {
  std::vector<int> ids;
  for (const Tag& tag : tags) {
    if (tag.segment == segment) ids.push_back(tag.id);
  }
  return ids;
}

PlainSession::Tag& PlainSession::tag(int id) {
  for (Tag& tag : tags) {
    if (tag.id == id) return tag;
  }
  throw std::runtime_error("no tag " + std::to_string(id));
}

PlainSession plain(const recordings::Session& session) {
  PlainSession out;
  out.stature_m = session.subject.stature_m;
  out.board = std::get<AprilGrid>(session.target);
  out.cameras = session.cameras;
  for (const TagOnSegment& tag : session.tags) {
    out.tags.push_back({number(tag.id), tag.segment, tag.size_m});
  }
  for (const recordings::Trial& trial : session.trials) {
    PlainSession::Trial plain_trial{
        trial.name, std::string(recordings::name(trial.kind)), "", {}};
    if (trial.rate) {
      plain_trial.extra += "fps = " + std::to_string(trial.rate->hz) + "\n";
    }
    if (trial.frames) {
      plain_trial.extra += "frames = [" + std::to_string(trial.frames->first) + ", " +
                           std::to_string(trial.frames->last) + "]\n";
    }
    for (const recordings::TrialVideo& video : trial.videos) {
      plain_trial.videos.emplace_back(
          session.cameras[static_cast<std::size_t>(video.camera)],
          std::filesystem::absolute(video.path).string());
    }
    out.trials.push_back(std::move(plain_trial));
  }
  return out;
}

std::string toml_of(const PlainSession& session) {
  std::ostringstream out;
  out << "format = 1\nname = \"mistaken\"\n[subject]\nname = \"S\"\nstature_m = "
      << session.stature_m << "\n[tags]\nfamily = " << quoted(session.family) << "\n";
  for (const PlainSession::Tag& tag : session.tags) {
    out << "[[tags.tag]]\nid = " << tag.id << "\nsegment = \"" << name(tag.segment)
        << "\"\nsize_m = " << tag.size_m << "\n";
  }
  const AprilGrid& board = session.board;
  out << "[board]\ntype = \"aprilgrid\"\nrows = " << board.rows
      << "\ncolumns = " << board.columns << "\ntag_size_m = " << board.tag_size_m
      << "\ngap_m = " << board.gap_m << "\nfirst_id = " << board.first_id
      << "\nthickness_m = " << board.thickness_m << "\n";
  for (const std::string& camera : session.cameras) {
    out << "[[camera]]\nname = " << quoted(camera) << "\n";
  }
  for (const PlainSession::Trial& trial : session.trials) {
    out << "[[trial]]\nname = " << quoted(trial.name) << "\nkind = " << quoted(trial.kind)
        << "\n"
        << trial.extra << "\nvideos = { ";
    for (std::size_t v = 0; v < trial.videos.size(); ++v) {
      out << (v == 0 ? "" : ", ") << trial.videos[v].first << " = "
          << quoted(trial.videos[v].second);
    }
    out << " }\n";
  }
  return out.str();
}

std::vector<SessionMistake> session_mistakes(const PlainSession& right) {
  Mistakes mistakes;
  add_exchanges_of_sides(mistakes);
  add_exchanges_of_segments(right, mistakes);
  add_exchanges_of_videos(right, mistakes);
  add_scales(right, mistakes);
  add_renames_and_omissions(right, mistakes);
  add_once_silent(right, mistakes);
  add_harmless(right, mistakes);
  return mistakes;
}

}  // namespace marey::benchmarks

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/doctor_commands.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "app/shell/version.h"
#include "capture/tags/detect_tags.h"
#include "capture/v4l2/probe_camera.h"
#include "capture/v4l2/v4l2_device.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the available memory in mebibytes; 0 if the system does not report it.
long available_memory_mib() {
  std::ifstream in("/proc/meminfo");
  std::string key;
  long kib = 0;
  std::string unit;
  while (in >> key >> kib >> unit) {
    if (key == "MemAvailable:") return kib / 1024;
  }
  return 0;
}

bool can_write_here() {
  std::error_code failed;
  const auto here = std::filesystem::current_path(failed);
  if (failed) return false;
  const auto probe = here / ".marey-doctor.partial";
  const bool ok = std::ofstream(probe).put('x').flush().good();
  std::filesystem::remove(probe, failed);
  return ok;
}

struct Check {
  std::string name;
  bool good = false;
  std::string finding;
  std::string advice;  ///< When not good.
  /// Exit code if the check fails. A small machine is not an error.
  Exit exit = Exit::kOk;
};

struct ExaminedCamera {
  capture::DeviceInfo device;
  capture::CameraProbe check;
};

std::vector<Check> examine_machine() {
  const unsigned cores = std::thread::hardware_concurrency();
  const long memory_mib = available_memory_mib();
  const bool writes = can_write_here();
  const bool detector = capture::TagDetector::create().has_value();
  return {{"processor",
           cores >= 2,
           std::to_string(cores) + " cores",
           "two cores or more keep up with four cameras"},
          {"memory",
           memory_mib >= 1500,
           std::to_string(memory_mib) + " MiB available",
           "close other programs: a session needs up to 1.5 GB"},
          {"working folder",
           writes,
           writes ? "can be written to" : "cannot be written to",
           "run marey in a folder that you can write to, or name one with --out",
           Exit::kDevice},
          {"tag detector",
           detector,
           detector ? "tag36h11 ready" : "cannot be started",
           "install libapriltag3",
           Exit::kInternal}};
}

/// Examines each camera for about a second, one after the other.
std::vector<ExaminedCamera> examine_cameras(
    const std::vector<capture::DeviceInfo>& devices) {
  std::vector<ExaminedCamera> cameras;
  for (const capture::DeviceInfo& device : devices) {
    if (device.modes.empty()) continue;
    capture::DeviceRequest request;
    request.path = device.path;
    cameras.push_back({device, capture::probe_camera(request)});
  }
  return cameras;
}

Check trouble(const Error& error) {
  return {"camera", false, error.where + ": " + error.cause, error.next, Exit::kDevice};
}

std::vector<Check> checks_of(const std::vector<ExaminedCamera>& cameras,
                             const std::vector<Error>& errors) {
  std::vector<Check> checks;
  for (const ExaminedCamera& camera : cameras) {
    const auto& check = camera.check;
    if (check.trouble && !check.in_use) {
      checks.push_back(trouble(*check.trouble));
    } else {
      checks.push_back({"camera",
                        true,
                        camera.device.path + " (" + camera.device.card +
                            "): " + capture::summary(check),
                        {}});
    }
  }
  for (const Error& error : errors) checks.push_back(trouble(error));
  if (checks.empty()) {
    checks.push_back({"cameras", true, "none is plugged in; videos need none", {}});
  }
  return checks;
}

Json json_of(const std::vector<capture::DeviceMode>& modes) {
  Json list = Json::array();
  for (const auto& mode : modes) {
    Json rates = Json::array();
    for (const FrameRate& rate : mode.rates) rates.push_back(rate.hz);
    list.push_back({{"format", capture::name(mode.format)},
                    {"width_px", mode.width_px},
                    {"height_px", mode.height_px},
                    {"rates_hz", rates}});
  }
  return list;
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const capture::DeviceSettings& settings) {
  return {{"format", capture::name(settings.format)},
          {"width_px", settings.width_px},
          {"height_px", settings.height_px},
          {"rate_hz", settings.rate.hz},
          {"exposure_s", or_null(settings.exposure_s)},
          {"exposure_is_automatic", settings.exposure_is_automatic},
          {"focus", or_null(settings.focus)},
          {"gain", or_null(settings.gain)},
          {"monotonic_clock", settings.monotonic_clock},
          {"differences", settings.differences}};
}

Json json_of(const ExaminedCamera& camera) {
  const auto& [device, check] = camera;
  Json out{{"path", device.path},
           {"card", device.card},
           {"bus", device.bus},
           {"driver", device.driver},
           {"in_use", check.in_use},
           {"trouble", check.trouble ? Json(check.trouble->message()) : Json(nullptr)},
           {"offers", json_of(device.modes)},
           {"chosen", check.settings ? json_of(*check.settings) : Json(nullptr)}};
  out["measured"] = {
      {"rate_hz", check.measured ? Json(check.measured->hz) : Json(nullptr)},
      {"frames", check.frames},
      {"dropped", check.dropped},
      {"damaged", check.damaged}};
  out["advice"] = check.advice;
  return out;
}

void print_json(const std::vector<Check>& checks,
                const std::vector<ExaminedCamera>& cameras,
                bool all_good) {
  Json list = Json::array();
  for (const Check& check : checks) {
    list.push_back(
        {{"check", check.name}, {"good", check.good}, {"finding", check.finding}});
    if (!check.good) list.back()["advice"] = check.advice;
  }
  Json seen = Json::array();
  for (const ExaminedCamera& camera : cameras) seen.push_back(json_of(camera));
  const Json out{
      {"version", kVersion}, {"good", all_good}, {"checks", list}, {"cameras", seen}};
  // Names of cameras may contain any bytes.
  std::printf("%s\n", out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

void print_line(const char* verdict, const std::string& what, const std::string& text) {
  std::printf("%-5s %-16s %s\n", verdict, what.c_str(), text.c_str());
}

void print_text(const std::vector<Check>& checks,
                const std::vector<ExaminedCamera>& cameras) {
  std::printf("marey %s\n", kVersion);
  for (const Check& check : checks) {
    print_line(check.good ? "ok" : "poor",
               check.name,
               check.finding + (check.good ? "" : ": " + check.advice));
  }
  for (const auto& [device, check] : cameras) {
    std::printf("\n%s: %s at %s, driver %s\n",
                device.path.c_str(),
                device.card.c_str(),
                device.bus.c_str(),
                device.driver.c_str());
    for (const std::string& line : capture::offers(device)) {
      print_line("", "offers", line);
    }
    if (check.settings) {
      print_line("", "chosen", capture::summary(check));
      for (const std::string& line : check.settings->differences) {
        print_line("", "", line);
      }
    }
    for (const std::string& line : check.advice) print_line("", "advice", line);
  }
}

}  // namespace

Exit run_doctor(bool json, Console& console) {
  std::vector<Check> checks = examine_machine();
  const capture::DeviceList found = capture::list_devices();
  const std::vector<ExaminedCamera> cameras = examine_cameras(found.devices);
  for (Check& check : checks_of(cameras, found.errors)) {
    checks.push_back(std::move(check));
  }
  const bool all_good = std::ranges::all_of(checks, &Check::good);
  if (json) {
    print_json(checks, cameras, all_good);
  } else {
    print_text(checks, cameras);
  }
  if (!all_good) console.warn("this machine fails some of the checks above");
  Exit exit = Exit::kOk;
  for (const Check& check : checks) {
    if (!check.good && check.exit != Exit::kOk) exit = check.exit;
  }
  return exit;
}

void add_doctor_command(CLI::App& app,
                        DoctorArguments& args,
                        std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand("doctor", "Check this machine");
  command->add_flag("--json", args.json, "Print the results as JSON on standard output");
  command->callback([&] {
    chosen = [&args](Console& console) { return run_doctor(args.json, console); };
  });
}

}  // namespace marey::app

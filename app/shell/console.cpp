// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/console.h"

#include <array>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "core/base/printable.h"

namespace marey::app {
namespace {

using Seconds = std::chrono::duration<double>;

std::string bar(const std::string& label, int done, int total, double elapsed_s) {
  std::array<char, 200> text{};
  const double rate = elapsed_s > 0.0 ? done / elapsed_s : 0.0;
  if (total == kUnknownTotal) {
    std::snprintf(
        text.data(), text.size(), "%-22s %d  %.0f/s", label.c_str(), done, rate);
    return text.data();
  }
  constexpr int kWidth = 24;
  const double share = static_cast<double>(done) / total;
  std::string cells(kWidth, '.');
  for (int i = 0; i < static_cast<int>(share * kWidth); ++i) {
    cells[static_cast<std::size_t>(i)] = '#';
  }
  const double left_s = rate > 0.0 ? (total - done) / rate : 0.0;
  std::snprintf(text.data(),
                text.size(),
                "%-22s [%s] %d/%d  %.0f/s  %.0f s left",
                label.c_str(),
                cells.c_str(),
                done,
                total,
                rate,
                left_s);
  return text.data();
}

/// Paths may contain bytes that are not UTF-8; JSON requires UTF-8.
constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;

void print_json(const nlohmann::ordered_json& line) {
  std::fprintf(stderr, "%s\n", line.dump(-1, ' ', false, kReplace).c_str());
}

}  // namespace

Console::Console(ProgressStyle style, ProgramName name)
    : style_(style), name_(std::move(name)), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress Console::stage(const std::string& label) {
  return [this, label, start = Clock::now()](int done, int total) {
    const std::scoped_lock lock(mutex_);
    show(label, done, total, start);
  };
}

void Console::show(const std::string& label,
                   int done,
                   int total,
                   Clock::time_point start) {
  if (style_ == ProgressStyle::kQuiet || style_ == ProgressStyle::kKept) return;
  const Clock::time_point now = Clock::now();
  const bool finished = total != kUnknownTotal && done >= total;
  const bool bar_style = style_ == ProgressStyle::kAuto && terminal_;
  const Seconds pause(bar_style ? 0.1 : (style_ == ProgressStyle::kJson ? 0.5 : 5.0));
  if (!finished && now - last_shown_ < pause) return;
  last_shown_ = now;
  const double elapsed_s = Seconds(now - start).count();
  if (style_ == ProgressStyle::kJson) {
    nlohmann::ordered_json line{{"stage", label}, {"done", done}};
    if (total != kUnknownTotal) line["total"] = total;
    line["elapsed_s"] = elapsed_s;
    print_json(line);
  } else if (bar_style) {
    std::fprintf(stderr, "\r\033[K%s", bar(label, done, total, elapsed_s).c_str());
    bar_shown_ = !finished;
    if (finished) std::fputc('\n', stderr);
  } else if (total == kUnknownTotal) {
    std::fprintf(stderr, "%s: %d, %.1f s\n", label.c_str(), done, elapsed_s);
  } else {
    std::fprintf(stderr, "%s: %d/%d, %.1f s\n", label.c_str(), done, total, elapsed_s);
  }
}

void Console::clear_bar() {
  if (bar_shown_) std::fputs("\r\033[K", stderr);
  bar_shown_ = false;
}

void Console::say(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  if (style_ == ProgressStyle::kQuiet || style_ == ProgressStyle::kKept) return;
  clear_bar();
  if (style_ == ProgressStyle::kJson) {
    print_json({{"message", text}});
  } else {
    std::fprintf(stderr, "%s\n", printable(as_called(text)).c_str());
  }
}

std::vector<std::string> Console::kept_warnings() const {
  const std::scoped_lock lock(mutex_);
  return kept_;
}

void Console::warn(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  if (style_ == ProgressStyle::kKept) {
    kept_.push_back(as_called(text));
    return;
  }
  clear_bar();
  if (style_ == ProgressStyle::kJson) {
    print_json({{"warning", text}});
  } else {
    std::fprintf(stderr, "warning: %s\n", printable(as_called(text)).c_str());
  }
}

Exit Console::fail(const Error& error) {
  const std::scoped_lock lock(mutex_);
  if (style_ == ProgressStyle::kKept) return exit_for(error.code);
  clear_bar();
  if (style_ == ProgressStyle::kJson) {
    print_json({{"error", error.message()}, {"exit_code", exit_for(error.code)}});
  } else {
    std::fprintf(stderr, "error: %s\n", printable(as_called(error.message())).c_str());
  }
  return exit_for(error.code);
}

std::string Console::as_called(const std::string& text) const {
  return name_.written_into(text);
}

}  // namespace marey::app

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/engine_log_file.h"

#include <bit>
#include <cstdint>
#include <vector>

#include "recordings/base/atomic_file.h"
#include "recordings/moves/page_sums.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kLogKind = "marey engine log ";
constexpr std::string_view kLogVersion = "1\n";
constexpr std::size_t kSumLength = 32;  // Hexadecimal digits.

// Appends values, least significant byte first.
class LogWriter {
 public:
  void number(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xFFU);
  }
  void real(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void text(const std::string& value) {
    number(value.size());
    bytes_ += value;
  }
  void texts(const std::vector<std::string>& values) {
    number(values.size());
    for (const std::string& value : values) text(value);
  }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

// Takes values off the front. After a value that is not there all are empty.
class LogReader {
 public:
  explicit LogReader(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number() {
    if (bytes_.size() < 8) return fail();
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      value |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
    }
    bytes_.remove_prefix(8);
    return value;
  }
  double real() { return std::bit_cast<double>(number()); }
  std::string text() {
    const std::uint64_t size = number();
    if (size > bytes_.size()) {
      fail();
      return {};
    }
    std::string out(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return out;
  }
  // The number of values that follow, each of at least `least` bytes.
  std::size_t count(std::size_t least) {
    const std::uint64_t value = number();
    if (value > bytes_.size() / least) return fail();
    return static_cast<std::size_t>(value);
  }
  std::vector<std::string> texts() {
    std::vector<std::string> out;
    for (std::size_t i = count(8); i > 0; --i) out.push_back(text());
    return out;
  }
  [[nodiscard]] bool is_whole() const { return !failed_ && bytes_.empty(); }

 private:
  std::uint64_t fail() {
    failed_ = true;
    bytes_ = {};
    return 0;
  }
  std::string_view bytes_;
  bool failed_ = false;
};

Error damaged_log(const std::string& file) {
  return bad_input(file,
                   "the log is damaged: its content differs from its sum",
                   "copy it again, or record the run again");
}

}  // namespace

std::string engine_log_bytes(const EngineLog& log) {
  LogWriter out;
  out.bytes() += kLogKind;
  out.bytes() += kLogVersion;
  out.real(log.step_hz);
  out.number(static_cast<std::uint64_t>(log.steps));
  out.texts(log.characters);
  out.texts(log.clips);
  out.number(log.requests.size());
  for (const EngineRequest& request : log.requests) {
    out.number(static_cast<std::uint64_t>(request.step));
    out.number(static_cast<std::uint64_t>(std::int64_t{request.character}));
    out.text(request.kind);
    out.number(request.numbers.size());
    for (const double value : request.numbers) out.real(value);
    out.texts(request.texts);
  }
  return out.bytes() + blob_sum(out.bytes());
}

Result<EngineLog> parse_engine_log(std::string_view bytes, const std::string& file) {
  if (!bytes.starts_with(kLogKind)) {
    return bad_input(
        file, "it is no log of an engine", "name a file that write_engine_log() wrote");
  }
  const std::string_view version =
      bytes.substr(kLogKind.size(), bytes.find('\n') - kLogKind.size() + 1);
  if (version != kLogVersion && version.size() < 12 && version.ends_with('\n')) {
    return bad_input(file,
                     "the log has another version than 1: " +
                         std::string(version.substr(0, version.size() - 1)),
                     "read it with the version of marey that wrote it");
  }
  if (bytes.size() < kLogKind.size() + kLogVersion.size() + kSumLength) {
    return damaged_log(file);
  }
  const std::string_view content = bytes.substr(0, bytes.size() - kSumLength);
  if (blob_sum(content) != bytes.substr(content.size())) return damaged_log(file);
  LogReader in(content.substr(kLogKind.size() + kLogVersion.size()));
  EngineLog log;
  log.step_hz = in.real();
  log.steps = static_cast<std::int64_t>(in.number());
  log.characters = in.texts();
  log.clips = in.texts();
  // Step, character, kind, and the numbers of numbers and texts.
  for (std::size_t i = in.count(40); i > 0; --i) {
    EngineRequest request;
    request.step = static_cast<std::int64_t>(in.number());
    const auto character = static_cast<std::int64_t>(in.number());
    request.character = static_cast<int>(character);
    if (request.character != character) return damaged_log(file);
    request.kind = in.text();
    for (std::size_t n = in.count(8); n > 0; --n) request.numbers.push_back(in.real());
    request.texts = in.texts();
    log.requests.push_back(std::move(request));
  }
  if (!in.is_whole()) return damaged_log(file);
  return log;
}

Status write_engine_log(const std::filesystem::path& path, const EngineLog& log) {
  return write_file(path, engine_log_bytes(log));
}

Result<EngineLog> read_engine_log(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  return parse_engine_log(*bytes, path.string());
}

}  // namespace marey::recordings

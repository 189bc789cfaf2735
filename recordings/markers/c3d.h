// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "recordings/base/atomic_file.h"

namespace marey::recordings {

// The content of a C3D file: header, parameters and frames, in the file's own unit and
// axes. marker_file.h returns markers in the world, force_plates.h returns forces.
// Follows the C3D User Guide (Motion Lab Systems) and accepts the known deviations of
// vendors.

/// Number format, named after the processor that wrote the file. The values are those of
/// the file format.
enum class C3dProcessor : std::uint8_t {
  kIntel = 84,  ///< Little-endian, IEEE.
  kDec = 85,    ///< Little-endian integers, VAX F reals.
  kMips = 86,   ///< Big-endian, IEEE. Also SGI's.
};

/// Type of the numbers in a frame: reals, or 16-bit integers that are multiplied by a
/// scale.
enum class C3dNumbers : std::uint8_t { kReal, kInteger };

struct C3dText {
  std::string characters;  ///< All texts, one after the other, including padding blanks.
};
using C3dBytes = std::vector<std::int8_t>;
using C3dIntegers = std::vector<std::int16_t>;
using C3dReals = std::vector<float>;

/// A named array. The first dimension varies fastest; for texts it is their length.
/// Without dimensions it is one value.
struct C3dParameter {
  std::string name;
  std::string description;
  bool locked = false;
  std::vector<std::uint8_t> dimensions;
  std::variant<C3dText, C3dBytes, C3dIntegers, C3dReals> values;
};

struct C3dGroup {
  std::string name;
  std::string description;
  bool locked = false;
  std::uint8_t id = 1;  ///< 1 to 127.
  std::vector<C3dParameter> parameters;
};

/// One of the at most 18 events in the header.
struct C3dHeaderEvent {
  std::string label;    ///< Up to four letters.
  double time_s = 0.0;  ///< Since frame 1.
  bool shown = true;
};

/// Content of a C3D before its frames, after reconciliation of contradictions.
struct C3dInfo {
  C3dProcessor processor = C3dProcessor::kIntel;
  C3dNumbers numbers = C3dNumbers::kReal;
  int points = 0;
  int analog_channels = 0;
  int analog_per_frame = 1;  ///< Samples per channel and frame.
  double rate_hz = 100.0;    ///< Frame rate.
  /// Length of one integer step and of one residual step, in the file's unit. Above 0.
  double scale = 0.1;
  int first_frame = 1;
  std::int64_t frames = 0;  ///< Number of complete frames in the file.
  int interpolation_gap = 0;
  std::vector<C3dGroup> groups;
  std::vector<C3dHeaderEvent> header_events;
  /// Errors of the file and their correction. Sentences without a full stop.
  std::vector<std::string> notes;
};

/// One frame as stored: reals, or integers that are not yet scaled.
struct C3dFrame {
  /// x, y, z and the word with residual and cameras, for each point.
  std::vector<float> points;
  /// The first sample of all channels, then the second one, and so on. Unsigned 16-bit
  /// integers are 0 to 65535.
  std::vector<float> analog;
};

/// Returns the parameter, or null if it is absent. Names match in any case. The pointer
/// is valid until `groups` changes.
[[nodiscard]] const C3dParameter* find_parameter(const std::vector<C3dGroup>& groups,
                                                 std::string_view group,
                                                 std::string_view name);

/// Returns the texts of a parameter without trailing blanks; empty if it holds numbers.
[[nodiscard]] std::vector<std::string> texts(const C3dParameter& parameter);

/// Returns the numbers of a parameter; empty if it holds texts. With `is_unsigned`,
/// integers are 0 to 65535.
[[nodiscard]] std::vector<double> numbers(const C3dParameter& parameter,
                                          bool is_unsigned = false);

/// Returns texts() of GROUP:NAME and of its continuations NAME2, NAME3..., which hold the
/// values beyond the 255 of one parameter. `numbers_of_all` does the same for numbers.
/// Empty if the parameter is absent.
[[nodiscard]] std::vector<std::string> texts_of_all(const std::vector<C3dGroup>& groups,
                                                    std::string_view group,
                                                    std::string_view name);
[[nodiscard]] std::vector<double> numbers_of_all(const std::vector<C3dGroup>& groups,
                                                 std::string_view group,
                                                 std::string_view name,
                                                 bool is_unsigned = false);

/// Adds a parameter to a group, which is created if absent. Replaces a parameter of the
/// same name; its description is kept if the new one has none.
void put_parameter(std::vector<C3dGroup>& groups,
                   std::string_view group,
                   C3dParameter parameter);

/// Calls put_parameter() for a list of texts, in pieces of 255 as texts_of_all() reads
/// them.
void put_texts(std::vector<C3dGroup>& groups,
               std::string_view group,
               std::string_view name,
               const std::vector<std::string>& list);

/// Reads a file frame by frame, in memory that does not grow with its length.
///
/// Corrects deviations of vendors and reports them in info().notes: a parameter section
/// that is not where the header points; damaged records; contradictory numbers of points,
/// samples or frames (the numbers that fit the file's size are used); files that end
/// early, of which the complete frames are read.
class C3dReader {
 public:
  /// Opens a file. Errors (kBadInput), with the byte: not a C3D file, no parameter
  /// section, no frame rate. Otherwise the errors of read_file().
  [[nodiscard]] static Result<C3dReader> open(const std::filesystem::path& path);
  /// Opens a file in memory. `name` is its name in messages.
  [[nodiscard]] static Result<C3dReader> of_bytes(std::string bytes, std::string name);

  C3dReader(C3dReader&&) noexcept;
  C3dReader& operator=(C3dReader&&) noexcept;
  ~C3dReader();

  [[nodiscard]] const C3dInfo& info() const;
  /// Reads the next frame into `frame`; returns false after the last one. Errors
  /// (kDevice): the disk failed, or the file became shorter.
  [[nodiscard]] Result<bool> next(C3dFrame& frame);

 private:
  struct State;
  explicit C3dReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a file frame by frame. Sets the parameters of `info` that repeat the header
/// (POINT:USED, FRAMES, SCALE, RATE, DATA_START; ANALOG:USED, RATE; TRIAL:ACTUAL_...);
/// writes all others unchanged. Frame counts above 65535 are stored in
/// TRIAL:ACTUAL_END_FIELD and POINT:LONG_FRAMES.
class C3dWriter {
 public:
  /// Creates the file. Errors (kBadInput): more points, samples or parameters than the
  /// format can store; errors of AtomicFile::create(). Precondition: numbers in `info`
  /// are not negative; rate and scale are above 0.
  [[nodiscard]] static Result<C3dWriter> create(const std::filesystem::path& path,
                                                const C3dInfo& info);

  /// Appends a frame. Integers are rounded and clamped to 16 bits; reals outside the VAX
  /// range become the largest VAX real. Precondition: the number of words is that of
  /// `info`; there are no more frames than in `info`.
  void append(const C3dFrame& frame);
  /// Commits the file. Errors: those of AtomicFile::commit(). Precondition: `info.frames`
  /// frames were appended.
  [[nodiscard]] Status commit();

 private:
  C3dWriter(AtomicFile file, const C3dInfo& info);
  AtomicFile file_;
  C3dProcessor processor_;
  C3dNumbers numbers_;
  std::size_t words_per_frame_;
  std::int64_t frames_left_;
  std::string bytes_;
};

/// Returns the bytes that C3dWriter writes before the frames. Errors: those of
/// C3dWriter::create().
[[nodiscard]] Result<std::string> c3d_head(const C3dInfo& info);

}  // namespace marey::recordings

// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/rows_file.h"

#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include <xxhash.h>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

constexpr std::array<char, 8> kRowsMagic = {'M', 'A', 'R', 'E', 'Y', 'R', 'O', 'W'};
constexpr std::uint32_t kRowsLayout = 1;
constexpr std::size_t kRowsHeaderBytes = 64;

/// The first bytes of NAME.f32.
struct RowsHeader {
  std::array<char, 8> magic = kRowsMagic;
  std::uint32_t layout = kRowsLayout;
  std::uint32_t columns = 0;
  std::uint64_t rows = 0;
  std::uint64_t clips = 0;
  std::uint64_t begins_hash = 0;  ///< XXH3, 64 bits, of the bytes of NAME.idx.
  std::uint64_t unused = 0;
  XXH128_canonical_t values_hash{};  ///< XXH3, 128 bits, of the bytes of all rows.
};
static_assert(sizeof(RowsHeader) == kRowsHeaderBytes);

template <class T>
std::string_view bytes_of_values(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

std::uint64_t hash_of_begins(std::span<const std::uint64_t> begins) {
  return XXH3_64bits(begins.data(), begins.size_bytes());
}

std::string header_bytes(std::size_t columns,
                         std::span<const std::uint64_t> begins,
                         XXH128_hash_t hash) {
  RowsHeader header;
  header.columns = static_cast<std::uint32_t>(columns);
  header.rows = begins.back();
  header.clips = begins.size() - 1;
  header.begins_hash = hash_of_begins(begins);
  XXH128_canonicalFromHash(&header.values_hash, hash);
  std::string out(kRowsHeaderBytes, '\0');
  std::memcpy(out.data(), &header, kRowsHeaderBytes);
  return out;
}

fs::path begins_path(const fs::path& path) {
  return fs::path(path).replace_extension(".idx");
}

Error bad_rows(const fs::path& path, std::string cause) {
  return bad_input(path.string(),
                   std::move(cause),
                   "remove it and build the library again: marey library build");
}

RowsHeader header_of(std::span<const std::byte> bytes) {
  RowsHeader header;
  std::memcpy(&header, bytes.data(), kRowsHeaderBytes);
  return header;
}

/// Checks a header, and that the file has exactly its rows.
Status check_header(const fs::path& path,
                    std::span<const std::byte> bytes,
                    std::size_t columns) {
  if (bytes.size() < kRowsHeaderBytes) {
    return bad_rows(path, "it is cut short, or no file of rows");
  }
  const RowsHeader header = header_of(bytes);
  if (header.magic != kRowsMagic) return bad_rows(path, "it is no file of rows");
  if (header.layout != kRowsLayout || header.unused != 0) {
    return bad_rows(path, "another version of marey wrote it");
  }
  if (header.columns != columns) {
    return bad_rows(path,
                    "its rows have " + std::to_string(header.columns) +
                        " numbers instead of " + std::to_string(columns) +
                        "; another version of marey wrote it");
  }
  const std::uint64_t values = (bytes.size() - kRowsHeaderBytes) / sizeof(float);
  const bool has_size = header.rows == values / columns && values % columns == 0 &&
                        bytes.size() == kRowsHeaderBytes + values * sizeof(float);
  if (!has_size) {
    return bad_rows(path,
                    "its size does not fit its " + std::to_string(header.rows) +
                        " rows: it was cut short or changed");
  }
  return Done{};
}

/// Reads the bytes of NAME.idx, which must have one number more than there are clips.
Result<std::vector<std::uint64_t>> read_begins(const fs::path& path,
                                               std::uint64_t clips) {
  const auto file = MappedFile::open(path);
  if (!file) {
    if (file.error().code == Errc::kDevice) return file.error();
    return bad_rows(path, file.error().cause);
  }
  const std::size_t count = file->bytes().size() / sizeof(std::uint64_t);
  const bool has_size = file->bytes().size() % sizeof(std::uint64_t) == 0 && count > 0 &&
                        count - 1 == clips;
  if (!has_size) {
    return bad_rows(path,
                    "its size does not fit " + std::to_string(clips) +
                        " clips: it was cut short, or belongs to other rows");
  }
  std::vector<std::uint64_t> begins(count);
  std::memcpy(begins.data(), file->bytes().data(), file->bytes().size());
  return begins;
}

/// Checks the first rows of clips: they ascend, from 0 to the number of all rows.
Status check_begins(const fs::path& path,
                    const RowsHeader& header,
                    std::span<const std::uint64_t> begins) {
  bool is_ordered = begins.front() == 0 && begins.back() == header.rows;
  for (std::size_t k = 1; k < begins.size(); ++k) {
    is_ordered = is_ordered && begins[k - 1] <= begins[k];
  }
  if (is_ordered && hash_of_begins(begins) == header.begins_hash) return Done{};
  return bad_rows(path, "the first rows of its clips are damaged, or of other rows");
}

}  // namespace

/// The hash of the values so far.
class RowsFileWriter::Checksum {
 public:
  Checksum() : state_(XXH3_createState(), XXH3_freeState) {
    MAREY_ASSERT(state_ != nullptr);
    XXH3_128bits_reset(state_.get());
  }
  void add(std::string_view bytes) {
    XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
  }
  [[nodiscard]] XXH128_hash_t value() const { return XXH3_128bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

RowsFileWriter::RowsFileWriter(fs::path path, AtomicFile file, std::size_t columns)
    : path_(std::move(path)),
      file_(std::move(file)),
      columns_(columns),
      checksum_(std::make_unique<Checksum>()) {}
RowsFileWriter::RowsFileWriter(RowsFileWriter&& other) noexcept = default;
RowsFileWriter::~RowsFileWriter() = default;

Result<RowsFileWriter> RowsFileWriter::create(const fs::path& path, std::size_t columns) {
  MAREY_ASSERT(columns > 0 && columns <= std::numeric_limits<std::uint32_t>::max());
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  // The header is known at the end.
  file->append(std::string(kRowsHeaderBytes, '\0'));
  return RowsFileWriter(path, *std::move(file), columns);
}

void RowsFileWriter::add_clip(std::span<const float> rows) {
  MAREY_ASSERT(rows.size() % columns_ == 0);
  const std::string_view bytes = bytes_of_values(rows);
  file_.append(bytes);
  checksum_->add(bytes);
  begins_.push_back(begins_.back() + rows.size() / columns_);
}

Status RowsFileWriter::commit() {
  file_.overwrite(0, header_bytes(columns_, begins_, checksum_->value()));
  const Status ok = write_file(begins_path(path_),
                               bytes_of_values(std::span<const std::uint64_t>(begins_)));
  if (!ok) return ok;
  return file_.commit();
}

std::string rows_file_bytes(std::span<const float> rows, std::size_t columns) {
  MAREY_ASSERT(columns > 0 && columns <= std::numeric_limits<std::uint32_t>::max());
  MAREY_ASSERT(rows.size() % columns == 0);
  const std::array<std::uint64_t, 2> begins{0, rows.size() / columns};
  std::string out =
      header_bytes(columns, begins, XXH3_128bits(rows.data(), rows.size_bytes()));
  out += bytes_of_values(rows);
  return out;
}

RowsFile::RowsFile(fs::path path, MappedFile file)
    : path_(std::move(path)), file_(std::move(file)) {}

Result<RowsFile> RowsFile::open(const fs::path& path, std::size_t columns) {
  MAREY_ASSERT(columns > 0);
  auto mapped = MappedFile::open(path);
  if (!mapped) {
    if (mapped.error().code == Errc::kDevice) return mapped.error();
    return bad_rows(path, mapped.error().cause);
  }
  if (const Status ok = check_header(path, mapped->bytes(), columns); !ok) {
    return ok.error();
  }
  RowsFile out(path, *std::move(mapped));
  out.columns_ = columns;
  const RowsHeader header = header_of(out.file_.bytes());
  fs::path place = path;
  if (header.clips == 1) {
    out.begins_ = {0, header.rows};
  } else {
    place = begins_path(path);
    auto begins = read_begins(place, header.clips);
    if (!begins) return begins.error();
    out.begins_ = *std::move(begins);
  }
  if (const Status ok = check_begins(place, header, out.begins_); !ok) return ok.error();
  return out;
}

RowsView RowsFile::rows() const {
  // The header's size keeps the values aligned.
  const auto* const values =
      reinterpret_cast<const float*>(file_.bytes().data() + kRowsHeaderBytes);
  return {
      {values, static_cast<std::size_t>(begins_.back()) * columns_}, columns_, begins_};
}

Status RowsFile::check_values() const {
  const auto values = file_.bytes().subspan(kRowsHeaderBytes);
  XXH128_canonical_t hash{};
  XXH128_canonicalFromHash(&hash, XXH3_128bits(values.data(), values.size()));
  const RowsHeader header = header_of(file_.bytes());
  if (std::memcmp(&hash, &header.values_hash, sizeof hash) == 0) return Done{};
  return bad_rows(path_, "its values are damaged: they do not fit their checksum");
}

}  // namespace marey::recordings

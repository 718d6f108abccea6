// Begin with write(), which encodes a frame.
#include <condition_variable>
#include <deque>
#include <exception>
#include <fstream>
#include <mutex>
#include <thread>

#include "engine/io/frame_parts.h"
#include "engine/io/recording/frame_coder.h"
#include "engine/io/recording/recording.h"
#include "engine/io/recording/recording_blocks.h"

namespace sunder {
namespace {

constexpr std::size_t kMaxQueued = 16;  // queued frames; a faster run has to wait

}  // namespace

/// State of a recording being written; implements the members of RecordingWriter.
class RecordingWriter::Recording {
 public:
  explicit Recording(const std::filesystem::path& path);
  ~Recording();
  void take(const FramePtr& frame);
  void finish();
  std::uint64_t bytes() const { return offset_; }

 private:
  void write_queued();
  void write(const Frame& frame);
  void write_new_meshes(const Frame& frame);
  void append(BlockKind kind, std::uint32_t first, std::uint64_t content_bytes,
              const std::vector<std::byte>& packed);
  void stop();

  std::filesystem::path path_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FramePtr> queue_;
  bool closed_ = false;
  std::exception_ptr failure_;

  // Members used by the writing thread only:
  std::ofstream out_;
  std::uint64_t offset_ = 0;
  std::vector<BlockPlace> places_;
  std::shared_ptr<const std::vector<Material>> materials_;
  std::size_t meshes_ = 0;
  std::uint32_t frames_ = 0;
  FrameCoder coder_;
  Packer frame_packer_, other_packer_;
  std::thread thread_;
};

RecordingWriter::Recording::Recording(const std::filesystem::path& path)
    : path_(path), out_(create_file(path)) {
  out_.write(kRecordingMagic, sizeof kRecordingMagic);
  out_.flush();
  if (!out_) throw FileError(path.string() + ": cannot be written; is the disk full?");
  offset_ = sizeof kRecordingMagic;
  thread_ = std::thread([this] { write_queued(); });
}

RecordingWriter::Recording::~Recording() { stop(); }

void RecordingWriter::Recording::take(const FramePtr& frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || queue_.size() < kMaxQueued; });
  if (failure_) std::rethrow_exception(failure_);
  queue_.push_back(frame);
  changed_.notify_all();
}

void RecordingWriter::Recording::stop() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void RecordingWriter::Recording::finish() {
  stop();
  if (failure_) std::rethrow_exception(failure_);
  ByteWriter index;
  for (const BlockPlace& place : places_) index.put(place.offset, place.kind, place.first);
  const std::uint64_t at = offset_;
  other_packer_.restart();
  append(BlockKind::kIndex, 0, index.bytes.size(), other_packer_.pack(index.bytes));
  ByteWriter end;
  end.put(at);
  for (const char c : kIndexMagic) end.put(c);
  out_.write(reinterpret_cast<const char*>(end.bytes.data()),
             static_cast<std::streamsize>(end.bytes.size()));
  offset_ += end.bytes.size();
  out_.close();
  if (!out_) throw FileError(path_.string() + ": cannot be written; is the disk full?");
}

void RecordingWriter::Recording::write_queued() {
  for (;;) {
    FramePtr frame;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return closed_ || !queue_.empty(); });
      if (queue_.empty()) return;
      frame = std::move(queue_.front());
      queue_.pop_front();
      changed_.notify_all();
    }
    try {
      write(*frame);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      changed_.notify_all();
      return;
    }
  }
}

void RecordingWriter::Recording::write(const Frame& frame) {
  if (!materials_) {
    materials_ = frame.materials;
    ByteWriter content;
    put(content, *materials_);
    put_names(content, frame.names ? *frame.names : std::vector<std::string>());
    if (frame.appearances) put(content, *frame.appearances);
    append(BlockKind::kMaterials, 0, content.bytes.size(), other_packer_.pack(content.bytes));
  }
  SUNDER_CHECK(frame.materials == materials_);  // a recording is of one run
  write_new_meshes(frame);
  const bool is_key = frames_ % kFramesPerGroup == 0;
  if (is_key) {
    coder_.reset();
    frame_packer_.restart();
  }
  ByteWriter content;
  coder_.write(content, frame);
  append(is_key ? BlockKind::kKeyFrame : BlockKind::kFrame, frames_++, content.bytes.size(),
         frame_packer_.pack(content.bytes));
  out_.flush();
  if (!out_) throw FileError(path_.string() + ": cannot be written; is the disk full?");
}

void RecordingWriter::Recording::write_new_meshes(const Frame& frame) {
  SUNDER_CHECK(frame.meshes->size() >= meshes_);
  if (frame.meshes->size() == meshes_) return;
  ByteWriter content;
  content.put(static_cast<std::uint32_t>(frame.meshes->size() - meshes_));
  std::vector<std::shared_ptr<const Mesh>> added;
  for (std::size_t m = meshes_; m < frame.meshes->size(); ++m) added.push_back((*frame.meshes)[m]);
  for (const std::shared_ptr<const Mesh>& mesh : added) put(content, *mesh);
  if (frame.appearances) put_uvs(content, added);
  other_packer_.restart();
  append(BlockKind::kMeshes, static_cast<std::uint32_t>(meshes_), content.bytes.size(),
         other_packer_.pack(content.bytes));
  meshes_ = frame.meshes->size();
}

void RecordingWriter::Recording::append(BlockKind kind, std::uint32_t first,
                                        std::uint64_t content_bytes,
                                        const std::vector<std::byte>& packed) {
  const std::vector<std::byte> block = make_block(kind, first, content_bytes, packed);
  places_.push_back({offset_, kind, first});
  out_.write(reinterpret_cast<const char*>(block.data()),
             static_cast<std::streamsize>(block.size()));
  offset_ += block.size();
}

RecordingWriter::RecordingWriter(const std::filesystem::path& path)
    : recording_(std::make_unique<Recording>(path)) {}
RecordingWriter::~RecordingWriter() = default;
void RecordingWriter::take(const FramePtr& frame) { recording_->take(frame); }
void RecordingWriter::finish() { recording_->finish(); }
std::uint64_t RecordingWriter::bytes() const { return recording_->bytes(); }

}  // namespace sunder

// Runs ffmpeg as a child process, started without a shell. Its input is a socket rather than a
// pipe, so that writing after its end is an error instead of SIGPIPE.
#include "render/image/encoder.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "engine/io/file_ending.h"

extern char** environ;

namespace sunder::render {
namespace {

using Words = std::vector<std::string>;

void append(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
}

/// Returns the command line. Colours are BT.709 and the file is tagged so: players guess otherwise.
Words arguments(const std::filesystem::path& file, bool webm, int width, int height,
                int frames_per_s) {
  Words words = {"ffmpeg", "-hide_banner", "-loglevel", "error", "-y"};
  append(words, {"-f", "rawvideo", "-pix_fmt", "rgb24"});
  append(words, {"-s", std::to_string(width) + "x" + std::to_string(height)});
  append(words, {"-r", std::to_string(frames_per_s), "-i", "pipe:0", "-an"});
  append(words, {"-vf", "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd", "-pix_fmt",
                 "yuv420p"});
  append(words, {"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"});
  append(words, {"-color_range", "tv"});
  if (webm) {
    append(words, {"-c:v", "libvpx-vp9", "-crf", "28", "-b:v", "0"});
    append(words, {"-deadline", "good", "-cpu-used", "5", "-row-mt", "1", "-f", "webm"});
  } else {
    append(words, {"-c:v", "libx264", "-preset", "veryfast", "-crf", "18"});
    append(words, {"-movflags", "+faststart", "-f", "mp4"});
  }
  words.push_back(file.string());
  return words;
}

/// Starts a program with the given standard input and output (also error). Returns 0 or an errno.
int spawn(std::vector<std::string> words, int input, int log, int& pid) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawnattr_t attributes;  // own process group, so that Ctrl-C reaches this program alone
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, log, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, log, STDERR_FILENO);
  const int error = ::posix_spawnp(&pid, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error;
}

/// Returns the processor time that a child has used; 0 if it has ended.
std::int64_t processor_ns(int pid) {
  clockid_t clock = 0;
  timespec used = {};
  if (::clock_getcpuclockid(pid, &clock) != 0 || ::clock_gettime(clock, &used) != 0) return 0;
  return used.tv_sec * std::int64_t{1'000'000'000} + used.tv_nsec;
}

void close_once(int& file) {
  if (file >= 0) ::close(file);
  file = -1;
}

}  // namespace

Encoder::Encoder(const std::filesystem::path& path, int width, int height, int frames_per_s,
                 std::function<bool()> is_stopped)
    : path_(path), file_(path), is_stopped_(std::move(is_stopped)), width_(width), height_(height) {
  if (width % 2 != 0 || height % 2 != 0) {
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    throw InputError(path.string() + ": a video needs an even width and height, not " +
                     size(width, height) + "; use --size " +
                     size(width + width % 2, height + height % 2));
  }
  if (is_device(path)) {
    throw InputError(path.string() +
                     ": a video cannot be written to a pipe or a device, because the encoder seeks "
                     "in the file; give a file, or a folder for images");
  }
  int ends[2] = {-1, -1};
  log_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  if (log_ < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    const std::string reason = std::strerror(errno);
    close_once(log_);
    throw InputError(path.string() + ": no socket to ffmpeg could be created: " + reason);
  }
  input_ = ends[0];
  const int error = spawn(
      arguments(file_.path(), has_ending(path.string(), ".webm"), width, height, frames_per_s),
      ends[1], log_, pid_);
  ::close(ends[1]);
  if (error == 0) {
    file_.set_writer(pid_);
    return;
  }
  close_once(input_);
  close_once(log_);
  throw InputError(path.string() + ": the program ffmpeg cannot be started (" +
                   std::strerror(error) +
                   "); on Debian or Ubuntu: apt-get install ffmpeg. Images (.png, or a folder) "
                   "need no ffmpeg.");
}

Encoder::~Encoder() {
  if (pid_ > 0) {
    ::kill(-pid_, SIGKILL);
    close_and_wait();
  }
  close_once(log_);
}

void Encoder::add(const Image& image) {
  SUNDER_CHECK(image.width == width_ && image.height == height_ && pid_ > 0);
  note_work();
  std::size_t sent = 0;
  while (sent < image.rgb.size()) {
    const ssize_t n = ::send(input_, image.rgb.data() + sent, image.rgb.size() - sent,
                             MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n >= 0) {
      sent += static_cast<std::size_t>(n);
      note_work();
    } else if (errno == EAGAIN) {
      wait_for_room();
    } else if (errno != EINTR) {
      fail();
    }
  }
  if (has_error_output()) fail();
}

void Encoder::finish() {
  if (!close_and_wait() || has_error_output()) fail();
  file_.publish();
}

/// Waits until ffmpeg can take more input, or for a short time.
void Encoder::wait_for_room() {
  constexpr int kWait_ms = 50;
  pollfd room = {input_, POLLOUT, 0};
  if (::poll(&room, 1, kWait_ms) == 0) kill_if_hanging();
}

void Encoder::note_work() { worked_ = std::chrono::steady_clock::now(); }

void Encoder::kill_if_hanging() {
  constexpr std::chrono::milliseconds kMostIdle(800);
  constexpr std::int64_t kWork_ns = 10'000'000;  // a shell that loops over `sleep 1` uses less
  const std::int64_t used_ns = processor_ns(pid_);
  if (!is_stopped_ || !is_stopped_() || used_ns - used_ns_ > kWork_ns) {
    used_ns_ = used_ns;
    return note_work();
  }
  if (killed_ || std::chrono::steady_clock::now() - worked_ < kMostIdle) return;
  killed_ = true;
  ::kill(-pid_, SIGKILL);
}

/// Returns true if ffmpeg has written any output: on a full disk it reports that but ends with 0.
bool Encoder::has_error_output() const {
  struct stat log = {};
  return ::fstat(log_, &log) == 0 && log.st_size > 0;
}

bool Encoder::close_and_wait() {
  constexpr std::chrono::milliseconds kWait(5);
  close_once(input_);
  note_work();
  int status = 0, ended = 0;
  while ((ended = ::waitpid(pid_, &status, WNOHANG)) == 0) {
    kill_if_hanging();
    std::this_thread::sleep_for(kWait);
  }
  file_.set_writer(0);
  pid_ = -1;
  return ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void Encoder::fail() {
  if (pid_ > 0) close_and_wait();
  if (killed_)
    throw FileError(path_.string() +
                    ": is not written: the program ffmpeg hangs, and was killed after the signal");
  std::array<char, 2000> words = {};
  const ssize_t size = ::pread(log_, words.data(), words.size() - 1, 0);
  const std::string reason = size > 0 ? words.data() : "no error message";
  if (reason.starts_with(file_.path().string() + ":"))
    throw FileError(path_.string() + ": cannot be written; check the folder and its permissions");
  throw FileError(path_.string() + ": the program ffmpeg (package ffmpeg) failed: " + reason);
}

}  // namespace sunder::render

#include "engine/model/frame.h"

namespace sunder {

void pump(FrameSource& source, std::span<FrameSink* const> sinks) {
  while (const FramePtr frame = source.next()) {
    for (FrameSink* sink : sinks) sink->take(frame);
  }
  for (FrameSink* sink : sinks) sink->finish();
}

}  // namespace sunder

// The few kinds of GL object, made complete in one call each. They die with their context.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>

#include "render/gl/table.h"

namespace sunder::render {

/// A linked program from the concatenated sources. Uniform block `Frame` is bound to 0. Throws
/// InputError with the driver's log if it refuses.
GLuint make_program(const GlTable& gl, const char* name,
                    std::initializer_list<const char*> vertex_sources,
                    std::initializer_list<const char*> fragment_sources);

/// Lets `sampler` of a program read texture unit `unit`.
void set_sampler(const GlTable& gl, GLuint program, const char* sampler, int unit);

enum class Filter { kNearest, kLinear };

/// A place in the bound buffer, as GL wants it.
inline const void* buffer_offset(std::size_t byte) { return reinterpret_cast<const void*>(byte); }

/// An empty texture, clamped to its edge.
GLuint make_texture(const GlTable& gl, GLenum format, int width, int height, Filter filter);
/// A 16-bit depth texture that compares when sampled; lit beyond its border.
GLuint make_shadow_texture(const GlTable& gl, int size);
/// A framebuffer of these textures; 0 for none.
GLuint make_framebuffer(const GlTable& gl, GLuint color, GLuint depth);

}  // namespace sunder::render

// The few kinds of GL object, made complete in one call each. They die with their context.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "render/gl/table.h"

namespace sunder::render {

/// A linked program from the concatenated sources. Uniform block `Frame` is bound to 0, samplers to
/// their units (units.h). Throws InputError with the driver's log if it refuses.
GLuint make_program(const GlTable& gl, const char* name,
                    std::initializer_list<const char*> vertex_sources,
                    std::initializer_list<const char*> fragment_sources);

/// A place in the bound buffer, as GL wants it.
inline const void* buffer_offset(std::size_t byte) { return reinterpret_cast<const void*>(byte); }

/// An attribute of the records in a buffer: how many floats, and where in a record.
struct Attribute {
  GLint floats;
  std::size_t place;
};
/// Enables attributes of the bound vertex array, `first` and so on, which read records of `stride`
/// bytes from `start` in the bound buffer on.
void set_attributes(const GlTable& gl, GLuint first, std::size_t stride,
                    std::initializer_list<Attribute> attributes, std::size_t start = 0);

/// Puts `data` in place of what a buffer held, and leaves it bound.
template <class T>
void fill_buffer(const GlTable& gl, GLenum target, GLuint buffer, const std::vector<T>& data,
                 GLenum usage) {
  gl.BindBuffer(target, buffer);
  gl.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
}

/// An empty texture, clamped to its edge; its texels are not mixed. Throws InputError if it is too
/// large for the device.
GLuint make_texture(const GlTable& gl, GLenum format, int width, int height);
/// A 16-bit depth texture that compares when sampled; lit beyond its border.
GLuint make_shadow_texture(const GlTable& gl, int size);
/// A framebuffer of these textures; 0 for none.
GLuint make_framebuffer(const GlTable& gl, GLuint color, GLuint depth);

}  // namespace sunder::render

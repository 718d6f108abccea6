// Creation of GL objects, one call for each kind. The objects live as long as their context.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "render/gl/table.h"

namespace sunder::render {

/// Returns a linked program of the concatenated sources. Uniform block `Frame` is bound to 0,
/// samplers to their units (units.h). Throws InputError with the driver's log on failure.
GLuint make_program(const GlTable& gl, const char* name,
                    std::initializer_list<const char*> vertex_sources,
                    std::initializer_list<const char*> fragment_sources);

/// Converts a byte offset in the bound buffer to the pointer that GL functions take.
inline const void* buffer_offset(std::size_t byte) { return reinterpret_cast<const void*>(byte); }

/// A vertex attribute in the records of a buffer.
struct Attribute {
  GLint floats;        ///< Number of floats.
  std::size_t offset;  ///< Offset in the record, in bytes.
};
/// Enables the attributes `first`, `first` + 1 and so on of the bound vertex array. They read
/// records of `stride` bytes in the bound buffer, from byte `start` on.
void set_attributes(const GlTable& gl, GLuint first, std::size_t stride,
                    std::initializer_list<Attribute> attributes, std::size_t start = 0);

/// Replaces the contents of a buffer by `data`, and leaves the buffer bound.
template <class T>
void fill_buffer(const GlTable& gl, GLenum target, GLuint buffer, const std::vector<T>& data,
                 GLenum usage) {
  gl.BindBuffer(target, buffer);
  gl.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
}

/// Makes an empty texture: nearest filtering, clamped. Throws InputError if it is too large.
GLuint make_texture(const GlTable& gl, GLenum format, int width, int height);
/// Makes a 16-bit depth texture with depth comparison; lit outside its border.
GLuint make_shadow_texture(const GlTable& gl, int size);
/// Makes a framebuffer of these textures; 0 stands for no texture.
GLuint make_framebuffer(const GlTable& gl, GLuint color, GLuint depth);

}  // namespace sunder::render

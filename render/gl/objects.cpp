#include "render/gl/objects.h"

#include <algorithm>
#include <string>

#include "engine/base/check.h"
#include "render/gl/units.h"

namespace sunder::render {
namespace {

GLuint compile(const GlTable& gl, const char* name, GLenum stage,
               std::initializer_list<const char*> sources) {
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, static_cast<GLsizei>(sources.size()), sources.begin(), nullptr);
  gl.CompileShader(shader);
  GLint done = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done != 0) return shader;
  char log[2000] = {};
  gl.GetShaderInfoLog(shader, sizeof log - 1, nullptr, log);
  throw InputError(std::string("the OpenGL driver refuses shader ") + name + ": " + log);
}

/// Makes a new 2D texture with the given filter, clamped to its edges, and leaves it bound.
GLuint new_texture(const GlTable& gl, GLint filter) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

GLuint make_program(const GlTable& gl, const char* name,
                    std::initializer_list<const char*> vertex_sources,
                    std::initializer_list<const char*> fragment_sources) {
  const GLuint program = gl.CreateProgram();
  for (const GLuint shader : {compile(gl, name, GL_VERTEX_SHADER, vertex_sources),
                              compile(gl, name, GL_FRAGMENT_SHADER, fragment_sources)}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);
  }
  gl.LinkProgram(program);
  GLint done = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &done);
  if (done == 0) {
    char log[2000] = {};
    gl.GetProgramInfoLog(program, sizeof log - 1, nullptr, log);
    throw InputError(std::string("the OpenGL driver refuses program ") + name + ": " + log);
  }
  const GLuint block = gl.GetUniformBlockIndex(program, "Frame");
  if (block != GL_INVALID_INDEX) gl.UniformBlockBinding(program, block, 0);
  gl.UseProgram(program);
  for (GLint unit = 0; const char* const sampler : kSamplers) {  // GL ignores samplers not in use
    gl.Uniform1i(gl.GetUniformLocation(program, sampler), unit++);
  }
  return program;
}

void set_attributes(const GlTable& gl, GLuint first, std::size_t stride,
                    std::initializer_list<Attribute> attributes, std::size_t start) {
  for (GLuint index = first; const Attribute& attribute : attributes) {
    gl.EnableVertexAttribArray(index);
    gl.VertexAttribPointer(index++, attribute.floats, GL_FLOAT, GL_FALSE,
                           static_cast<GLsizei>(stride), buffer_offset(start + attribute.offset));
  }
}

GLuint make_texture(const GlTable& gl, GLenum format, int width, int height) {
  const std::string size = "--size " + std::to_string(width) + "x" + std::to_string(height);
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (std::max(width, height) > most) {
    throw InputError(size + ": the largest picture that this device draws is " +
                     std::to_string(most) + "x" + std::to_string(most));
  }
  const GLuint texture = new_texture(gl, GL_NEAREST);
  const bool depth = format == GL_DEPTH_COMPONENT24;
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0,
                depth ? GL_DEPTH_COMPONENT : GL_RGBA, depth ? GL_UNSIGNED_INT : GL_UNSIGNED_BYTE,
                nullptr);
  if (gl.GetError() != GL_NO_ERROR) {
    throw InputError(size + ": this device has not enough memory for pictures so large; give a " +
                     "smaller size");
  }
  return texture;
}

GLuint make_shadow_texture(const GlTable& gl, int size) {
  const GLuint texture = new_texture(gl, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  // The border is lit: clamping to the edge would stretch the outermost texels into lines.
  constexpr float kFarthest[] = {1, 1, 1, 1};
  gl.TexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, kFarthest);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT16, size, size, 0, GL_DEPTH_COMPONENT,
                GL_UNSIGNED_SHORT, nullptr);
  return texture;
}

GLuint make_framebuffer(const GlTable& gl, GLuint color, GLuint depth) {
  GLuint framebuffer = 0;
  gl.GenFramebuffers(1, &framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  if (color != 0) {
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
  }
  if (depth != 0) {
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  }
  const GLenum buffer = color != 0 ? GL_COLOR_ATTACHMENT0 : GL_NONE;
  gl.DrawBuffers(1, &buffer);
  gl.ReadBuffer(buffer);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw InputError("the OpenGL driver refuses a framebuffer that version 3.3 promises");
  }
  return framebuffer;
}

}  // namespace sunder::render

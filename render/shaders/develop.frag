// A sum of light to picture.
uniform sampler2D sums;
in vec2 at;
out vec4 color;

void main() { color = developed(texelFetch(sums, ivec2(gl_FragCoord.xy), 0).rgb, at); }

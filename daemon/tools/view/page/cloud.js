'use strict';
// The point cloud, in WebGL: turns by itself until it is dragged.
class Cloud {
  constructor(canvas) {
    this.canvas = canvas;
    this.yaw = 0;
    this.pitch = 0.25;
    this.dragged = 0;
    this.count = 0;
    const gl = this.gl = canvas.getContext('webgl', { preserveDrawingBuffer: true });
    if (!gl) return;
    const program = this.program = gl.createProgram();
    const add = (type, source) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    };
    add(gl.VERTEX_SHADER, `
      attribute vec3 point; attribute vec3 colour; varying vec3 shown;
      uniform vec4 turn; uniform vec3 centre; uniform vec2 lens;
      void main() {
        vec3 p = point - centre;
        p = vec3(turn.x * p.x + turn.y * p.z, p.y, turn.x * p.z - turn.y * p.x);
        p = vec3(p.x, turn.z * p.y - turn.w * p.z, turn.z * p.z + turn.w * p.y);
        p += vec3(0.0, 0.0, 1.2 * centre.z);
        gl_Position = vec4(lens.x * p.x, -lens.y * p.y, p.z - 0.2, p.z);
        gl_PointSize = clamp(3.0 * centre.z / p.z, 1.5, 6.0);
        shown = colour;
      }`);
    add(gl.FRAGMENT_SHADER, 'precision mediump float; varying vec3 shown; void main() { gl_FragColor = vec4(shown, 1.0); }');
    gl.linkProgram(program);
    gl.useProgram(program);
    for (const name of ['point', 'colour']) {
      this[name] = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, this[name]);
      const at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 0, 0);
    }
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0.05, 0.06, 0.075, 1);
    canvas.addEventListener('pointermove', event => {
      if (!event.buttons) return;
      this.yaw += event.movementX * 0.01;
      this.pitch = Math.max(-1.5, Math.min(1.5, this.pitch + event.movementY * 0.01));
      this.dragged = performance.now();
    });
    const turn = () => {
      if (performance.now() - this.dragged > 5000) this.yaw = 0.5 * Math.sin(performance.now() / 3000);
      this.draw();
      requestAnimationFrame(turn);
    };
    requestAnimationFrame(turn);
  }

  // x, y, z of each point in metres, red, green and blue of each from 0 to 1.
  show(points, colours) {
    const gl = this.gl;
    if (!gl) return;
    this.count = points.length / 3;
    const depths = [];
    for (let i = 2; i < points.length; i += 3 * 31) depths.push(points[i]);
    depths.sort((a, b) => a - b);
    const middle = depths.length ? depths[depths.length >> 1] : 1;
    this.centre = this.centre ? this.centre + 0.1 * (middle - this.centre) : middle;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.point);
    gl.bufferData(gl.ARRAY_BUFFER, points, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colour);
    gl.bufferData(gl.ARRAY_BUFFER, colours, gl.DYNAMIC_DRAW);
  }

  draw() {
    const gl = this.gl;
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.count) return;
    const at = name => gl.getUniformLocation(this.program, name);
    gl.uniform4f(at('turn'), Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch));
    gl.uniform3f(at('centre'), 0, 0, this.centre);
    gl.uniform2f(at('lens'), 1.6, 1.6 * this.canvas.width / this.canvas.height);
    gl.drawArrays(gl.POINTS, 0, this.count);
  }
}

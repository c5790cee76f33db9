// SPDX-License-Identifier: BSD-3-Clause
// Draws the point cloud with WebGL. It turns slowly until it is dragged. Where drawing is slow, as without a graphics card, it
// shows fewer points and turns in larger steps.
export class Cloud {
  constructor(canvas) {
    this.canvas = canvas;
    this.yaw = 0;
    this.pitch = 0.25;
    this.dragged = 0;
    this.count = 0;
    this.spacing = 2;  // from point to point, px of the rectified image
    this.began = 0;    // time of the latest draw(), ms
    this.fence = null; // signalled when the graphics card has finished it
    this.took = 16;    // duration of a draw(), smoothed, ms
    const gl = this.gl = canvas.getContext('webgl2', { preserveDrawingBuffer: true, antialias: false });
    if (!gl) return;
    const program = this.program = gl.createProgram();
    const add = (type, source) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    };
    add(gl.VERTEX_SHADER, `
      attribute vec4 point; varying float shown;
      uniform vec4 turn; uniform vec3 center; uniform vec2 lens; uniform float size;
      void main() {
        vec3 p = point.xyz - center;
        p = vec3(turn.x * p.x + turn.y * p.z, p.y, turn.x * p.z - turn.y * p.x);
        p = vec3(p.x, turn.z * p.y - turn.w * p.z, turn.z * p.z + turn.w * p.y);
        p += vec3(0.0, 0.0, 1.2 * center.z);
        gl_Position = vec4(lens.x * p.x, -lens.y * p.y, p.z - 0.2, p.z);
        gl_PointSize = clamp(size * center.z / p.z, 1.5, 2.0 * size);
        shown = point.w;
      }`);
    add(gl.FRAGMENT_SHADER, 'precision mediump float; varying float shown; void main() { gl_FragColor = vec4(shown * vec3(1.0, 0.97, 0.9), 1.0); }');
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    const at = gl.getAttribLocation(program, 'point');
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 4, gl.FLOAT, false, 0, 0);
    this.uniform = {};
    for (const name of ['turn', 'center', 'lens', 'size']) this.uniform[name] = gl.getUniformLocation(program, name);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0.05, 0.06, 0.075, 1);
    canvas.addEventListener('pointermove', event => {
      if (!event.buttons) return;
      this.yaw += event.movementX * 0.01;
      this.pitch = Math.max(-1.5, Math.min(1.5, this.pitch + event.movementY * 0.01));
      this.dragged = performance.now();
    });
    const turn = now => {
      requestAnimationFrame(turn);
      if (!this.isDone(now) || now - this.began < 3 * this.took) return;
      if (now - this.dragged > 5000) this.yaw = 0.5 * Math.sin(now / 3000);
      this.draw();
      this.began = now;
      this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      gl.flush();
    };
    requestAnimationFrame(turn);
  }

  // Replaces the points: x, y, z [m] and brightness [0…1] of each.
  show(points) {
    const gl = this.gl;
    if (!gl) return;
    this.count = points.length / 4;
    const depths = [];
    for (let i = 2; i < points.length; i += 4 * 31) depths.push(points[i]);
    depths.sort((a, b) => a - b);
    const middle = depths.length ? depths[depths.length >> 1] : 1;
    this.center = this.center ? this.center + 0.1 * (middle - this.center) : middle;
    gl.bufferData(gl.ARRAY_BUFFER, points, gl.DYNAMIC_DRAW);
  }

  // Returns without blocking whether the latest draw() is finished, and adapts the spacing of the points.
  isDone(now) {
    const gl = this.gl;
    if (!this.fence) return true;
    if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    gl.deleteSync(this.fence);
    this.fence = null;
    this.took += 0.3 * (Math.min(now - this.began, 200) - this.took);  // limited, because a hidden tab draws nothing
    if (this.took > 40 && this.spacing < 8) this.spacing++, this.took = 30;
    if (this.took < 20 && this.spacing > 2) this.spacing--, this.took = 30;
    return true;
  }

  draw() {
    const gl = this.gl;
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.count) return;
    gl.uniform4f(this.uniform.turn, Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch));
    gl.uniform3f(this.uniform.center, 0, 0, this.center);
    gl.uniform2f(this.uniform.lens, 1.6, 1.6 * this.canvas.width / this.canvas.height);
    gl.uniform1f(this.uniform.size, 1.5 * this.spacing);
    gl.drawArrays(gl.POINTS, 0, this.count);
  }
}

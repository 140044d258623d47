// The streamed picture, and its mouse and keyboard controls.

import { streamAt, oncePerFrame } from "/realcam/stream.js";
import { clippedShare, drawHistogram, histogramOf, marksOf } from "/realcam/exposure_marks.js";

const CLICK_PX = 4; // a press that moves less is a click
const KEY_STEP = 0.04; // camera movement per key press, in heights of the picture
const MAGNIFICATION = 4;

export default {
  props: { path: String },
  template: `
<section class="rc-picture" aria-label="Picture">
  <div class="rc-stage" ref="stage" :style="stageStyle">
    <canvas ref="canvas" class="rc-canvas" tabindex="0" role="img" :aria-label="description"
      aria-describedby="rc-picture-keys"
      @pointerdown="press" @pointermove="move" @pointerup="release" @pointercancel="release"
      @pointerleave="showsMagnifier = false" @wheel.prevent="wheel" @keydown="key" @contextmenu.prevent></canvas>
    <canvas ref="marks" class="rc-marks" v-show="clipping || peaking"></canvas>
    <canvas ref="magnifier" class="rc-magnifier" width="200" height="200" v-show="magnifier && showsMagnifier"
      :style="magnifierStyle"></canvas>
    <div v-if="mark" class="rc-crosshair" :style="mark"></div>
    <div v-if="denoised.a" class="rc-badge" data-testid="denoised">denoised</div>
    <div v-if="compares && denoised.b" class="rc-badge rc-right">denoised</div>
    <div v-if="compares" class="rc-wipe-line" :style="{ left: 100 * wipe + '%' }"></div>
    <div v-if="!isConnected" class="rc-lost" role="alert">Connection lost. Reconnecting...</div>
  </div>
  <p id="rc-picture-keys" class="rc-hidden">Arrow keys move the camera around its subject, with Shift sideways, plus and
    minus nearer and farther. F focuses and M meters in the middle. [ and ] turn the aperture ring, comma and period the
    shutter dial, I and Shift I the ISO dial, Z and Shift Z the zoom ring.</p>
  <div class="rc-toolbar">
    <fieldset aria-label="A click in the picture sets"><span>Click:</span>
      <label title="Focuses on the point that you click"><input type="radio" value="focus" v-model="mode"> Focus</label>
      <label title="Sets the exposure so that the point that you click becomes middle grey"><input type="radio" value="meter" v-model="mode"> Meter</label>
    </fieldset>
    <label title="Marks sharp edges in yellow"><input type="checkbox" v-model="peaking"> Peaking</label>
    <label title="Marks clipped pixels by stripes"><input type="checkbox" v-model="clipping"> Clipping</label>
    <label class="rc-for-mouse" title="Magnifies the picture under the mouse four times"><input type="checkbox" v-model="magnifier"> Magnifier</label>
    <label v-if="compares" class="rc-wipe">Wipe <input type="range" min="0" max="1" step="0.005" v-model.number="wipe"
      aria-label="Position of the line between both pictures"></label>
    <canvas ref="histogram" class="rc-histogram" width="192" height="48" role="img"
      aria-label="Histogram of red, green and blue, from black to white"></canvas>
    <output class="rc-status" data-testid="status">{{ status }}</output>
  </div>
  <p v-if="problem" class="rc-problem" role="alert" data-testid="picture-problem">{{ problem }}</p>
</section>`,
  data: () => ({
    mode: "focus", peaking: false, clipping: false, magnifier: false, showsMagnifier: false, magnifierStyle: {},
    wipe: 0.5, compares: false, isConnected: true, mark: null, header: null, clipped: 0, problem: "", denoised: {},
  }),
  computed: {
    status() {
      const h = this.header;
      if (!h) return "No picture yet";
      const noise = h.noise_codes === null ? "" : `, noise ${h.noise_codes.toFixed(1)} grey levels`;
      const done = h.is_final ? ", done" : h.is_preview ? ", preview" : "";
      const clipped = this.clipped > 0.0005 ? `, ${(100 * this.clipped).toFixed(1)}% clipped` : "";
      return `${h.width} × ${h.height} pixels, ${h.samples} sample${h.samples === 1 ? "" : "s"}${noise}${clipped}${done}`;
    },
    /// Fits the picture to the column's width and to most of the window's height.
    stageStyle() {
      const h = this.header;
      return h ? { width: `min(100%, ${(75 * h.whole_width) / h.whole_height}vh)` } : {};
    },
    description() {
      return `The picture through the lens. ${this.status}`;
    },
  },
  watch: {
    wipe() { this.draw(); },
    peaking() { this.drawMarks(); },
    clipping() { this.drawMarks(); },
  },
  created() {
    this.bitmaps = {}; // not reactive: Vue need not watch pictures
  },
  mounted() {
    this.stream = streamAt(this.path);
    this.ends = [
      this.stream.on("frame", (frame) => this.showFrame(frame)),
      this.stream.on("connection", ({ isOpen }) => { this.isConnected = isOpen; }),
      this.stream.on("problem", ({ problem }) => { this.problem = problem?.view === "picture" ? problem.message : ""; }),
    ];
    this.sendHover = oncePerFrame((u, v) => this.stream.send({ type: "hover", u, v }));
    this.drawMarksSoon = oncePerFrame(() => this.drawMarks());
  },
  unmounted() {
    this.ends.forEach((end) => end());
  },
  methods: {
    /// Shows a frame.
    showFrame({ header, bitmap }) {
      this.bitmaps[header.slot]?.close();
      this.bitmaps[header.slot] = bitmap;
      this.denoised[header.slot] = header.is_denoised;
      if (header.slot === "a") {
        this.header = header;
        this.drawMarksSoon();
      }
      const canvas = this.$refs.canvas;
      if (header.slot === "a" && (canvas.width !== header.whole_width || canvas.height !== header.whole_height)) {
        canvas.width = header.whole_width;
        canvas.height = header.whole_height;
      }
      this.draw();
      this.magnify();
      this.$emit("frame", { ...header });
    },
    /// Shows or hides the second picture.
    setComparison(compares) {
      this.compares = compares;
      if (!compares) {
        this.bitmaps.b?.close();
        delete this.bitmaps.b;
      }
      this.draw();
    },
    /// Draws the picture, and the second one to the right of the wipe line.
    draw() {
      const canvas = this.$refs.canvas, context = canvas.getContext("2d");
      const { a, b } = this.bitmaps;
      if (a) context.drawImage(a, 0, 0, canvas.width, canvas.height);
      if (b && this.compares) {
        const from = Math.round(this.wipe * canvas.width);
        context.save();
        context.beginPath();
        context.rect(from, 0, canvas.width - from, canvas.height);
        context.clip();
        context.drawImage(b, 0, 0, canvas.width, canvas.height);
        context.restore();
      }
    },
    /// Updates the histogram, the share of clipped pixels, and the overlay of marks.
    drawMarks() {
      const a = this.bitmaps.a;
      if (!a) return;
      const scratch = (this.scratch ??= document.createElement("canvas"));
      // A reduced resolution is sufficient for a histogram, but not for edges and stripes.
      const scale = this.peaking || this.clipping ? 1 : Math.min(1, 320 / a.width);
      scratch.width = Math.max(1, Math.round(a.width * scale));
      scratch.height = Math.max(1, Math.round(a.height * scale));
      const context = scratch.getContext("2d", { willReadFrequently: true });
      context.drawImage(a, 0, 0, scratch.width, scratch.height);
      const image = context.getImageData(0, 0, scratch.width, scratch.height);
      this.clipped = clippedShare(image);
      drawHistogram(this.$refs.histogram, histogramOf(image));
      if (this.peaking || this.clipping) {
        const marks = this.$refs.marks;
        marks.width = scratch.width;
        marks.height = scratch.height;
        marks.getContext("2d").putImageData(marksOf(image, { clipping: this.clipping, peaking: this.peaking, noise: this.header.noise_tiles }), 0, 0);
      }
    },
    /// Picture coordinates u, v (0 to 1, from the upper left corner) of the mouse.
    point(event) {
      const box = this.$refs.canvas.getBoundingClientRect();
      const within = (x) => Math.min(1, Math.max(0, x));
      return [within((event.clientX - box.left) / box.width), within((event.clientY - box.top) / box.height)];
    },
    press(event) {
      this.$refs.canvas.setPointerCapture(event.pointerId);
      this.pressed = { x: event.clientX, y: event.clientY, moved: 0, pans: event.shiftKey || event.button !== 0 };
    },
    move(event) {
      if (this.pressed) {
        const height = this.$refs.canvas.getBoundingClientRect().height;
        const x = (event.clientX - this.pressed.x) / height, y = (event.clientY - this.pressed.y) / height;
        this.pressed.moved += Math.hypot(event.clientX - this.pressed.x, event.clientY - this.pressed.y);
        Object.assign(this.pressed, { x: event.clientX, y: event.clientY });
        if (this.pressed.moved >= CLICK_PX) this.stream.send({ type: this.pressed.pans ? "pan" : "orbit", x, y: -y });
        return;
      }
      const [u, v] = this.point(event);
      this.sendHover(u, v);
      this.showsMagnifier = true;
      this.mouse = { x: event.clientX, y: event.clientY, u, v };
      this.magnify();
    },
    release(event) {
      if (this.pressed && this.pressed.moved < CLICK_PX && event.type === "pointerup") {
        const [u, v] = this.point(event);
        this.act(this.mode, u, v);
      }
      this.pressed = null;
    },
    /// Focuses or meters at a point of the picture, and marks it.
    act(mode, u, v) {
      this.stream.send({ type: mode, u, v });
      this.mark = { left: `${100 * u}%`, top: `${100 * v}%` };
      clearTimeout(this.markTimer);
      this.markTimer = setTimeout(() => { this.mark = null; }, 1200);
      this.$emit("picked", { u, v });
    },
    wheel(event) {
      // A mouse wheel scrolls by 100 pixels or 3 lines per notch, a trackpad by a few pixels at a time.
      const notches = event.deltaY / (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 3 : 100);
      if (notches) this.stream.send({ type: "dolly", steps: -0.5 * Math.max(-3, Math.min(3, notches)) });
    },
    /// Draws the magnifier beside the mouse.
    magnify() {
      if (!this.magnifier || !this.mouse) return;
      const { x, y, u, v } = this.mouse;
      const canvas = this.$refs.canvas, target = this.$refs.magnifier, box = this.$refs.stage.getBoundingClientRect();
      // The page scales the picture; the loupe magnifies relative to the scaled picture.
      const size = (target.width / MAGNIFICATION) * (canvas.width / box.width);
      const side = (mouse, length) => (mouse + 16 + target.width < length ? mouse + 16 : mouse - 16 - target.width);
      const left = side(x - box.left, box.width), top = side(y - box.top, box.height);
      this.magnifierStyle = { left: `${left}px`, top: `${top}px` };
      const context = target.getContext("2d");
      context.imageSmoothingEnabled = false;
      context.fillRect(0, 0, target.width, target.height); // black beyond the picture's edge
      context.drawImage(canvas, u * canvas.width - size / 2, v * canvas.height - size / 2, size, size,
        0, 0, target.width, target.height);
    },
    key(event) {
      const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      const turn = { "[": ["aperture", -1], "]": ["aperture", 1], ",": ["shutter", -1], ".": ["shutter", 1],
        i: ["iso", 1], I: ["iso", -1], z: ["zoom", 1], Z: ["zoom", -1] }[event.key];
      // On many keyboards, brackets are typed with these modifiers.
      if ((event.ctrlKey || event.metaKey || event.altKey) && !"[]".includes(event.key)) return;
      if (direction) {
        this.stream.send({ type: event.shiftKey ? "pan" : "orbit", x: -KEY_STEP * direction[0], y: -KEY_STEP * direction[1] });
      } else if (turn) this.stream.send({ type: "turn", ring: turn[0], steps: turn[1] });
      else if (event.key === "+" || event.key === "=") this.stream.send({ type: "dolly", steps: 1 });
      else if (event.key === "-") this.stream.send({ type: "dolly", steps: -1 });
      else if (event.key === "f") this.act("focus", 0.5, 0.5);
      else if (event.key === "m") this.act("meter", 0.5, 0.5);
      else return;
      event.preventDefault();
    },
  },
};

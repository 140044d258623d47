// Effects with the planner's decisions, and costs of the picture.

import { streamAt } from "/realcam/stream.js";

/// Text of a number with two digits at least, without an exponent: 0.012, 1.5, 108.
const short = (x) => String(x < 100 ? Number(x.toPrecision(2)) : Math.round(x));
const W = 300, H = 120, LEFT = 34, BOTTOM = 20; // size of the diagram, and its margins for labels

export default {
  props: { path: String, effects: Array, colours: Array },
  template: `
<section class="rc-costs" aria-label="Effects and cost">
  <p class="rc-note">An effect on "auto" is simulated if it is visible in this picture.</p>
  <ul class="rc-effects">
    <li v-for="e in effects" :key="e.name" :title="e.help">
      <label :for="'rc-effect-' + e.name">{{ labelOf(e.name) }}</label>
      <select :id="'rc-effect-' + e.name" :data-effect="e.name" :value="states[e.name]" @change="choose(e.name, $event.target.value)">
        <option value="auto">auto{{ planned(rows[e.name]) }}</option>
        <option value="on">on</option><option value="off">off</option></select>
      <span class="rc-size" :title="rows[e.name]?.reason">{{ sizeSentence(e.name) }}</span>
    </li>
    <li v-for="row in others" :key="row.effect" :title="row.reason"><b>{{ labelOf(row.effect) }}</b><span>by the camera model</span>
      <span class="rc-size">{{ sizeSentence(row.effect) }}</span></li>
  </ul>
  <p v-if="note" class="rc-note">{{ note }}</p>
  <details><summary>Reasons of the planner</summary><ul class="rc-reasons"><li v-for="row in all" :key="row.effect"><b>{{ row.effect }}</b>: {{ row.reason }}</li></ul></details>
  <template v-if="costs">
    <div class="rc-bar" role="img" :aria-label="barText" :title="barText">
      <span class="rc-bar-lens" :style="{ flexGrow: costs.lens_share }"></span><span class="rc-bar-scene" :style="{ flexGrow: costs.scene_share }"></span><span class="rc-bar-other" :style="{ flexGrow: costs.other_share }"></span>
    </div>
    <p class="rc-note">{{ barText }}. {{ large(costs.samples_per_s) }} samples/s, {{ large(costs.rays_per_s) }} rays/s;
      {{ (100 * costs.passing_share).toFixed(1) }}% of the rays into the lens pass it.</p>
  </template>
  <svg class="rc-noise" viewBox="0 0 ${W} ${H}" role="img" aria-label="Noise of this picture, and errors of the levels of simulation, in grey levels of 255 over time, both logarithmic">
    <line x1="${LEFT}" y1="${H - BOTTOM}" x2="${W}" y2="${H - BOTTOM}" /><line x1="${LEFT}" y1="0" x2="${LEFT}" y2="${H - BOTTOM}" />
    <text x="${(W + LEFT) / 2}" y="${H - 4}" text-anchor="middle">time (s), {{ range[0] }} to {{ range[1] }}</text>
    <text x="10" y="${(H - BOTTOM) / 2}" text-anchor="middle" transform="rotate(-90 10 ${(H - BOTTOM) / 2})">error (levels)</text>
    <text x="${LEFT - 3}" y="9" text-anchor="end">{{ top }}</text><text x="${LEFT - 3}" y="${H - BOTTOM}" text-anchor="end">{{ bottom }}</text>
    <polyline class="rc-curve" :points="curve" />
    <g v-for="(level, k) in plottedLevels" :key="level.name" class="rc-level" :style="{ color: colour(k) }">
      <title>{{ level.name }}</title><polyline :points="level.line" /><circle v-for="(p, j) in level.points" :key="j" :cx="p[0]" :cy="p[1]" r="2.5" /></g>
  </svg>
  <button type="button" @click="stream.send({ type: 'levels' })"
    title="Renders this shot at every level of simulation, at a low resolution, and shows the error over time of each">Measure the levels of simulation</button>
  <p v-if="levelsNote" class="rc-note" data-testid="levels-note">{{ levelsNote }}</p>
  <ul class="rc-legend"><li v-for="(level, k) in levels" :key="level.name"><span :style="{ background: colour(k) }"></span>{{ level.name }}</li></ul>
</section>`,
  data: () => ({ states: {}, all: [], note: "", costs: null, points: [], levels: [], levelsNote: "", serial: 0 }),
  computed: {
    rows() {
      return Object.fromEntries(this.all.map((row) => [row.effect, row]));
    },
    others() {
      const names = new Set(this.effects.map((e) => e.name));
      return this.all.filter((row) => !names.has(row.effect));
    },
    barText() {
      const percent = (x) => `${Math.round(100 * x)}%`;
      return `Time: lens ${percent(this.costs.lens_share)}, scene ${percent(this.costs.scene_share)}, ` +
        `shading and effects ${percent(this.costs.other_share)}`;
    },
    /// Ends of the axes: times in s, then noise in grey levels.
    limits() {
      const all = [...this.points, ...this.levels.flatMap((r) => r.points)].filter(([t, n]) => t > 0 && n > 0);
      if (!all.length) return [0.01, 10, 0.5, 20];
      const t = all.map((p) => p[0]), n = all.map((p) => p[1]);
      return [Math.min(...t) / 1.2, Math.max(...t) * 1.2, Math.min(...n) / 1.3, Math.max(...n) * 1.3];
    },
    range() { return this.limits.slice(0, 2).map(short); },
    bottom() { return short(this.limits[2]); },
    top() { return short(this.limits[3]); },
    curve() {
      return this.points.map(([t, n]) => this.positionOf(t, n).join(",")).join(" ");
    },
    plottedLevels() {
      return this.levels.map(({ name, points }) => {
        const placed = points.filter((p) => p[0] > 0 && p[1] > 0).map((p) => this.positionOf(...p));
        return { name, points: placed, line: placed.map((p) => p.join(",")).join(" ") };
      });
    },
  },
  mounted() {
    this.stream = streamAt(this.path);
    this.ends = [
      this.stream.on("plan", ({ rows, note, states }) => {
        this.all = rows.map((row) => ({ ...row, size: row.size ?? Infinity })); // JSON has no infinity
        this.note = note;
        this.states = states;
      }),
      this.stream.on("levels", ({ levels, note }) => { this.levels = levels; this.levelsNote = note; }),
      this.stream.on("frame", ({ header }) => this.addFrame(header)),
    ];
  },
  unmounted() {
    this.ends.forEach((end) => end());
  },
  methods: {
    /// Adds a frame's noise to the curve, and shows its costs.
    addFrame(header) {
      if (header.slot !== "a") return;
      if (header.costs) this.costs = header.costs;
      const isAgain = header.is_final && header.samples === this.samples; // the same picture at a higher JPEG quality
      this.samples = header.samples;
      if (header.serial !== this.serial) {
        this.serial = header.serial;
        if (isAgain) return;
        this.points = [];
      }
      const last = this.points[this.points.length - 1];
      if (header.noise_codes && (!last || last[1] !== header.noise_codes)) this.points.push([header.seconds, header.noise_codes]);
    },
    /// Position in the diagram of a time and a noise.
    positionOf(t, n) {
      const [t0, t1, n0, n1] = this.limits, fraction = (x, a, b) => Math.log(x / a) / Math.log(b / a);
      return [LEFT + (W - LEFT) * fraction(t, t0, t1), (H - BOTTOM) * (1 - fraction(n, n0, n1))];
    },
    colour(k) { return this.colours[k % this.colours.length]; },
    planned: (row) => (!row ? "" : row.is_kept ? " (on)" : " (off)"),
    labelOf: (name) => name[0].toUpperCase() + name.slice(1).replaceAll("_", " "),
    /// Sentence about the size of an effect in this picture.
    sizeSentence(name) {
      const row = this.rows[name], digits = (x) => (x === Infinity ? "∞" : String(Number(x.toPrecision(2))));
      if (!row) return "";
      const unit = row.unit === "px" ? "pixel" : "grey level", size = digits(row.size);
      const limit = `below ${digits(row.threshold)} it would be invisible`;
      const why = !row.is_kept && row.size > row.threshold ? ". It is off nevertheless, for the reason shown with the effect." : `; ${limit}.`;
      return `It changes this picture by ${size} ${unit}${size === "1" ? "" : "s"}${why}`;
    },
    choose(effect, state) {
      this.states = { ...this.states, [effect]: state };
      this.stream.send({ type: "switch", effect, state });
    },
    /// Text of a large number with a prefix.
    large: (x) => (x >= 999.5e6 ? `${(x / 1e9).toPrecision(3)} G` : x >= 999.5e3 ? `${(x / 1e6).toPrecision(3)} M` : `${(x / 1e3).toPrecision(3)} k`),
  },
};

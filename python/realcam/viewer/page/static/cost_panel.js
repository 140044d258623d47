// Effects with the planner's decisions, and costs of the picture.

import { streamAt } from "/realcam/stream.js";

// Colours that are visible on a light page and a dark one.
const COLOURS = ["#4a78d6", "#c7791a", "#2f9a58", "#d9493c", "#9467bd", "#15939f", "#b0608f", "#80803a", "#5b8f9e", "#e0709a", "#a0642d", "#8f8f8f"];
const W = 300, H = 120, LEFT = 34, BOTTOM = 20;

export default {
  props: { path: String, effects: Array },
  template: `
<section class="rc-costs" aria-label="Effects and cost">
  <p class="rc-note">An effect on "auto" is simulated if this picture shows it.</p>
  <ul class="rc-effects">
    <li v-for="e in effects" :key="e.name" :title="e.help">
      <label :for="'rc-effect-' + e.name">{{ label_of(e.name) }}</label>
      <select :id="'rc-effect-' + e.name" :data-effect="e.name" :value="states[e.name]" @change="choose(e.name, $event.target.value)">
        <option value="auto">auto{{ planned(rows[e.name]) }}</option>
        <option value="on">on</option><option value="off">off</option></select>
      <span class="rc-size" :title="rows[e.name]?.reason">{{ size(e.name) }}</span>
    </li>
    <li v-for="row in others" :key="row.effect" :title="row.reason"><b>{{ label_of(row.effect) }}</b><span>by the camera model</span>
      <span class="rc-size">{{ size(row.effect) }}</span></li>
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
  <svg class="rc-noise" viewBox="0 0 ${W} ${H}" role="img" aria-label="Noise in grey levels of 255 over time, both logarithmic">
    <line x1="${LEFT}" y1="${H - BOTTOM}" x2="${W}" y2="${H - BOTTOM}" /><line x1="${LEFT}" y1="0" x2="${LEFT}" y2="${H - BOTTOM}" />
    <text x="${(W + LEFT) / 2}" y="${H - 4}" text-anchor="middle">time (s), {{ range[0] }} to {{ range[1] }}</text>
    <text x="10" y="${(H - BOTTOM) / 2}" text-anchor="middle" transform="rotate(-90 10 ${(H - BOTTOM) / 2})">noise (levels)</text>
    <text x="${LEFT - 3}" y="9" text-anchor="end">{{ top }}</text><text x="${LEFT - 3}" y="${H - BOTTOM}" text-anchor="end">{{ bottom }}</text>
    <polyline class="rc-curve" :points="curve" />
    <g v-for="(rung, k) in placedRungs" :key="rung.name" class="rc-rung" :style="{ color: colour(k) }">
      <title>{{ rung.name }}</title><polyline :points="rung.line" /><circle v-for="(p, j) in rung.points" :key="j" :cx="p[0]" :cy="p[1]" r="2.5" /></g>
  </svg>
  <button type="button" @click="stream.send({ type: 'rungs' })"
    title="Takes this shot at every level of simulation, in few pixels, and shows what each costs">Measure the levels of simulation</button>
  <p v-if="rungsNote" class="rc-note" data-testid="rungs-note">{{ rungsNote }}</p>
  <ul class="rc-legend"><li v-for="(rung, k) in rungs" :key="rung.name"><span :style="{ background: colour(k) }"></span>{{ rung.name }}</li></ul>
</section>`,
  data: () => ({ states: {}, all: [], note: "", costs: null, points: [], rungs: [], rungsNote: "", serial: 0 }),
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
    limits() {
      const all = [...this.points, ...this.rungs.flatMap((r) => r.points)].filter(([t, n]) => t > 0 && n > 0);
      if (!all.length) return [0.01, 10, 0.5, 20];
      const t = all.map((p) => p[0]), n = all.map((p) => p[1]);
      return [Math.min(...t) / 1.2, Math.max(...t) * 1.2, Math.min(...n) / 1.3, Math.max(...n) * 1.3];
    },
    range() { return this.limits.slice(0, 2).map((x) => x.toPrecision(2)); },
    bottom() { return this.limits[2].toPrecision(2); },
    top() { return this.limits[3].toPrecision(2); },
    curve() {
      return this.points.map(([t, n]) => this.at(t, n).join(",")).join(" ");
    },
    placedRungs() {
      return this.rungs.map(({ name, points }) => {
        const placed = points.filter((p) => p[0] > 0 && p[1] > 0).map((p) => this.at(...p));
        return { name, points: placed, line: placed.map((p) => p.join(",")).join(" ") };
      });
    },
  },
  mounted() {
    this.stream = streamAt(this.path);
    this.ends = [
      this.stream.on("plan", ({ rows, note, states }) => { this.all = rows; this.note = note; this.states = states; }),
      this.stream.on("rungs", ({ rungs, note }) => { this.rungs = rungs; this.rungsNote = note; }),
      this.stream.on("frame", ({ header }) => this.take(header)),
    ];
  },
  unmounted() {
    this.ends.forEach((end) => end());
  },
  methods: {
    take(header) {
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
    at(t, n) {
      const [t0, t1, n0, n1] = this.limits, share = (x, a, b) => Math.log(x / a) / Math.log(b / a);
      return [LEFT + (W - LEFT) * share(t, t0, t1), (H - BOTTOM) * (1 - share(n, n0, n1))];
    },
    colour: (k) => COLOURS[k % COLOURS.length],
    planned: (row) => (!row ? "" : row.is_kept ? " (on)" : " (off)"),
    label_of: (name) => name[0].toUpperCase() + name.slice(1).replaceAll("_", " "),
    /// Sentence about the size of an effect in this picture.
    size(name) {
      const row = this.rows[name], short = (x) => (x === null ? "∞" : String(Number(x.toPrecision(2)))); // JSON has no infinity
      if (!row) return "";
      const unit = row.unit === "px" ? "pixel" : "grey level", size = short(row.size);
      const limit = `less than ${short(row.threshold)} would not be seen`;
      const why = !row.is_kept && row.size > row.threshold ? ". It is off all the same: the reason stands with the effect." : `; ${limit}.`;
      return `It changes this picture by ${size} ${unit}${size === "1" ? "" : "s"}${why}`;
    },
    choose(effect, state) {
      this.states = { ...this.states, [effect]: state };
      this.stream.send({ type: "switch", effect, state });
    },
    large: (x) => (x >= 1e9 ? `${(x / 1e9).toPrecision(3)} G` : x >= 1e6 ? `${(x / 1e6).toPrecision(3)} M` : `${(x / 1e3).toPrecision(3)} k`),
  },
};

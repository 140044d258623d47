// The lens: a section to scale with surfaces that can be dragged, and the table of surfaces.

import { streamAt, oncePerFrame } from "/realcam/stream.js";
import { profile, radiusOfSag, sag } from "/realcam/lens_shape.js";

// First-order data: key of the view, label, unit, help.
const FIGURES = [
  ["effective_focal_length_mm", "Focal length", "mm", "Distance from the rear principal plane to the rear focal point"],
  ["f_number", "f-number", "", "Focal length over the diameter of the entrance pupil"],
  ["back_focal_distance_mm", "Back focal distance", "mm", "From the last surface to the rear focal point"],
  ["film_distance_mm", "Film distance", "mm", "From the last surface to the film"],
  ["entrance_pupil_diameter_mm", "Entrance pupil", "mm", "Diameter of the stop as seen from the object"],
  ["exit_pupil_diameter_mm", "Exit pupil", "mm", "Diameter of the stop as seen from the film"],
];
// Columns: key of the row, label, unit, help.
const RADIUS = ["radius_mm", "Radius", "mm", "Radius of curvature; positive if the centre lies on the film's side, empty for a plane"];
const RADIUS_X = ["radius_x_mm", "Radius in xz", "mm", "Radius of curvature in the xz plane, for toroids and biconics; the other radius is in the yz plane"];
const COLUMNS = [
  ["thickness_mm", "Thickness", "mm", "Along the axis to the next surface"],
  ["glass", "Glass", "", "Medium behind the surface: empty for air, an index, an index and an Abbe number, or a name"],
  ["semi_diameter_mm", "Semi-diameter", "mm", "From the axis to the rim, beyond which no light passes"],
  ["conic", "Conic", "", "0 for a sphere, -1 for a paraboloid"],
];

/// Points (z, y) as the attribute of an SVG polyline.
const text = (points) => points.map(([z, y]) => `${z},${y}`).join(" ");

// Id of the last drag; starts at random, so that it differs from those before a reload of the page.
let gestures = Math.floor(Math.random() * 2 ** 30);

export default {
  props: { path: String, glasses: Array },
  template: `
<section class="rc-lens" aria-label="Lens">
  <div class="rc-lens-head">
    <h2>{{ view ? view.title || view.name : "No lens yet" }}</h2>
    <button type="button" @click="send('undo')" :disabled="!history.can_undo" title="Undo the last change of lens, zoom or film (Ctrl+Z)">Undo</button>
    <button type="button" @click="send('redo')" :disabled="!history.can_redo" title="Redo the last change that was undone (Ctrl+Y)">Redo</button>
  </div>
  <svg v-if="view" ref="svg" class="rc-section" :viewBox="box.join(' ')" preserveAspectRatio="xMidYMid meet"
      role="img" :aria-label="'Section of ' + view.name" @pointermove="drag" @pointerup="drop" @pointercancel="drop">
    <g transform="scale(1,-1)">
      <line class="rc-axis" :x1="box[0]" :x2="box[0] + box[2]" y1="0" y2="0" />
      <polygon v-for="(e, k) in shapes.elements" :key="'e' + k" class="rc-glass" :points="e" />
      <g v-for="(bundle, b) in paths" :key="'b' + b" :class="'rc-rays rc-rays-' + b">
        <polyline v-for="(path, k) in bundle" :key="k" :points="path" />
      </g>
      <polygon v-for="(c, k) in shapes.overlaps" :key="'c' + k" class="rc-overlap" :points="c" />
      <g v-for="(face, f) in view.faces" :key="'f' + face.surface" :class="faceClass(face)">
        <polyline v-for="(part, k) in shapes.faces[f]" :key="k" :points="part" />
        <polyline v-for="(part, k) in shapes.faces[f]" :key="'hit' + k" class="rc-hit" :points="part"
          :data-surface="face.surface" @pointerdown.stop="choose(face.surface)" />
      </g>
      <g v-for="(b, k) in view.blockers" :key="'s' + b.surface" :class="b.is_stop ? 'rc-stop' : 'rc-blocker'">
        <polyline v-for="(line, l) in shapes.blockers[k]" :key="l" :points="line" />
      </g>
      <polyline class="rc-film" :points="shapes.film" />
      <g v-if="showsMarks">
        <g v-for="m in view.marks" :key="m.label" class="rc-mark">
          <line :x1="m.z" :x2="m.z" :y1="-(m.half || 0.04 * box[3])" :y2="m.half || 0.04 * box[3]" />
        </g>
      </g>
      <polyline v-if="dragged" :class="['rc-dragged', problem ? 'rc-impossible' : '']" :points="dragged" />
      <g v-if="surface && handles.length">
        <circle v-for="h in handles" :key="h.field" class="rc-handle" :cx="h.at[0]" :cy="h.at[1]" :r="0.022 * box[3]"
          :data-handle="h.field" @pointerdown.stop="startDrag($event, h)"><title>{{ h.title }}</title></circle>
      </g>
    </g>
    <g v-if="showsMarks" class="rc-mark">
      <text v-for="m in view.marks" :key="'t' + m.label" :x="m.z" :y="-(m.half || 0.04 * box[3]) - 0.02 * box[3]" :font-size="0.05 * box[3]">{{ m.label }}</text>
    </g>
  </svg>
  <div v-if="view" class="rc-lens-head">
    <label title="Blue faces have their centre of curvature on the film's side, red ones on the object's"><input type="checkbox" v-model="colours"> Signs of the radii</label>
    <label v-if="!view.is_rotational" title="Shows the section in the xz plane instead of the yz plane"><input type="checkbox" :checked="view.plane === 'xz'" @change="send('cut', { plane: $event.target.checked ? 'xz' : 'yz' })"> From above</label>
    <label title="Marks pupils, principal planes and focal points"><input type="checkbox" v-model="showsMarks"> Pupils and planes</label>
    <span class="rc-note">{{ handles.length ? "Drag a dot to change surface " + (chosen + 1) + "." : "Click a surface of the drawing to change it." }}</span>
  </div>
  <p v-if="problem" class="rc-problem" role="alert" data-testid="problem">{{ problem.message }}</p>
  <p v-else-if="rays.note" class="rc-problem">{{ rays.note }}</p>
  <dl v-if="view" class="rc-figures">
    <div v-for="[key, label, unit, help] in figures" :key="key" :title="help"><dt>{{ label }}</dt>
      <dd :data-testid="key">{{ number(view.figures[key], 4) }} {{ unit }}</dd></div>
  </dl>
  <div v-if="view" class="rc-table-scroll">
  <table class="rc-table">
    <caption class="rc-hidden">Surfaces from the object to the film</caption>
    <thead><tr><th scope="col">#</th>
      <th v-for="[key, label, unit, help] in columns" :key="key" scope="col" :title="help">{{ label }}<small v-if="unit"> ({{ unit }})</small></th>
      <th scope="col"><span class="rc-hidden">Changes</span></th></tr></thead>
    <tbody>
      <tr v-for="(row, s) in view.surfaces" :key="s" v-memo="[view, chosen, typed, problem]" :class="{ 'rc-chosen': s === chosen, 'rc-bad': problem && problem.surface === s }"
          @focusin="chosen = s">
        <th scope="row">{{ s + 1 }}<small v-if="row.type !== 'refracting'"> {{ row.type }}</small></th>
        <td v-for="[key, label, unit] in columns" :key="key">
          <input v-if="has(row, key)" :value="typed?.cell === s + '-' + key ? typed.text : shown(row, key)"
            @input="typed = { cell: s + '-' + key, text: $event.target.value }" @blur="typed = null" :aria-label="label + ' of surface ' + (s + 1)" :data-cell="s + '-' + key"
            :style="{ minWidth: widths[key] }" :list="key === 'glass' ? 'rc-glasses' : null" :readonly="key === 'thickness_mm' && s + 1 === view.surfaces.length"
            @change="edit(s, key, $event.target.value)">
        </td>
        <td class="rc-row-buttons">
          <button type="button" @click="send('insert', { surface: s })" :aria-label="'Insert a plate before surface ' + (s + 1)" title="Insert a plate of glass before this surface">+</button>
          <button type="button" @click="send('remove', { surface: s })" :aria-label="'Delete surface ' + (s + 1)" title="Delete this surface">×</button>
          <button type="button" :disabled="s === 0" @click="send('swap', { surface: s, other: s - 1 })" :aria-label="'Move surface ' + (s + 1) + ' towards the object'" title="Swap with the surface before">↑</button>
          <button type="button" :disabled="s + 1 === view.surfaces.length" @click="send('swap', { surface: s, other: s + 1 })" :aria-label="'Move surface ' + (s + 1) + ' towards the film'" title="Swap with the surface behind">↓</button>
        </td>
      </tr>
    </tbody>
  </table>
  <datalist v-once id="rc-glasses"><option v-for="name in glasses" :key="name" :value="name"></option></datalist>
  </div>
  <div v-if="view" class="rc-lens-head rc-sample" title="Replaces the lens by a manufactured copy: radii, thicknesses, glass and centring have random errors within the tolerances of the class">
    <label>Tolerance class <select v-model="grade">
      <option value="commercial">commercial</option><option value="precision">precision</option><option value="high">high precision</option></select></label>
    <button type="button" @click="send('another_copy', { grade })">Make a production sample</button>
    <span class="rc-note">A manufactured copy with random errors within this class. Undo restores the lens.</span>
  </div>
</section>`,
  data: () => ({
    view: null, rays: { bundles: [], note: "" }, problem: null, chosen: null, typed: null, dragged: null, box: [0, 0, 1, 1], colours: false, showsMarks: false,
    history: { can_undo: false, can_redo: false }, grade: "commercial", figures: FIGURES,
  }),
  computed: {
    // SVG paths, computed once for each lens and not at each step of a drag.
    shapes() {
      const { elements, overlaps, faces, blockers, film } = this.view;
      return {
        elements: elements.map(text), overlaps: overlaps.map(text), faces: faces.map((f) => f.parts.map(text)),
        blockers: blockers.map((b) => b.lines.map(text)), film: text(film),
      };
    },
    paths() {
      return this.rays.bundles.map((bundle) => bundle.map(text));
    },
    surface() {
      return this.view && this.chosen !== null ? this.view.surfaces[this.chosen] : null;
    },
    /// Drag handles of the chosen surface, and their positions.
    handles() {
      const s = this.surface;
      if (!s || !this.view.is_in_place) return []; // a drag moves points along the axis and away from it
      const rim = s.semi_diameter_mm, bends = s.type !== "stop" && s.type !== "aperture";
      const list = [{ field: "semi_diameter_mm", at: [s.z + sag(s, rim), rim], title: "Drag the rim" }];
      if (bends) list.push({ field: "radius_mm", at: [s.z + sag(s, 0.7 * rim), -0.7 * rim], title: "Drag the curvature" });
      if (this.chosen > 0) list.push({ field: "thickness_mm", at: [s.z, 0], title: "Drag along the axis" });
      return list;
    },
    columns() {
      const powers = new Set();
      for (const row of this.view?.surfaces ?? []) Object.keys(row.aspheric).forEach((p) => powers.add(Number(p)));
      const terms = [...powers].sort((a, b) => a - b);
      const radii = this.view?.surfaces.some((row) => "radius_x_mm" in row) ? [RADIUS, RADIUS_X] : [RADIUS];
      return [...radii, ...COLUMNS, ...terms.map((p) => [`a${p}`, `A${p}`, `mm^${1 - p}`, `Aspheric coefficient of r^${p}`])];
    },
    /// Widths of the columns, wide enough for their longest values.
    widths() {
      const longest = (key) => Math.max(6, ...this.view.surfaces.filter((row) => this.has(row, key)).map((row) => this.shown(row, key).length));
      return Object.fromEntries(this.columns.map(([key]) => [key, `calc(${longest(key)}ch + 0.75rem)`]));
    },
  },
  mounted() {
    this.stream = streamAt(this.path);
    this.ends = [
      this.stream.on("lens", (view) => this.show(view)),
      this.stream.on("rays", (rays) => { this.rays = Object.freeze(rays); }),
      this.stream.on("problem", ({ problem }) => { this.problem = problem?.view === "lens" ? problem : null; }),
    ];
    this.undoes = (event) => this.undoByKey(event);
    window.addEventListener("keydown", this.undoes);
    this.sendDrag = oncePerFrame((message) => this.stream.send(message));
  },
  unmounted() {
    window.removeEventListener("keydown", this.undoes);
    this.ends.forEach((end) => end());
  },
  methods: {
    /// Shows a new lens view; see lens_view.py.
    show(view) {
      const cell = document.activeElement;
      const isMarked = cell?.dataset.cell && cell.selectionEnd - cell.selectionStart === cell.value.length;
      if (this.typed?.isSent) this.typed = null;
      this.view = Object.freeze(view); // not reactive: Vue need not watch each point
      if (isMarked) this.$nextTick(() => cell.select()); // so that further typing replaces the new value as well
      if (this.chosen !== null && this.chosen >= view.surfaces.length) this.chosen = null;
      if (this.held) return; // the scale is fixed during a drag
      this.dragged = null;
      this.fit();
    },
    setHistory(can_undo, can_redo) {
      this.history = { can_undo, can_redo };
    },
    /// Fits the view to film, faces and stops.
    fit() {
      const v = this.view, points = [...v.film, ...v.faces.flatMap((f) => f.parts.flat()), ...v.blockers.flatMap((b) => b.lines.flat())];
      const zs = points.map(([z]) => z), ys = points.map(([, y]) => y);
      const front = Math.min(...zs), back = Math.max(...zs), low = Math.min(...ys), high = Math.max(...ys);
      const length = Math.max(back - front, 0.5 * (high - low)), left = front - 0.25 * length, air = 0.06 * (high - low);
      this.box = [left, -high - air, back + 0.05 * length - left, high - low + 2 * air];
    },
    /// CSS classes of a face.
    faceClass(face) {
      const sign = !this.colours ? "" : face.sign > 0 ? "rc-positive" : face.sign < 0 ? "rc-negative" : "rc-plane";
      const bad = this.problem?.surface === face.surface ? "rc-impossible" : "";
      return ["rc-face", face.is_mirror ? "rc-mirror" : "", sign, bad, face.surface === this.chosen ? "rc-chosen" : ""];
    },
    /// Chooses a surface, by its index, for its drag handles.
    choose(s) {
      this.chosen = s;
    },
    /// True if the surface of this row has a value in the column.
    has: (row, key) => key === "radius_x_mm" ? key in row : row.type === "refracting" || !["glass"].includes(key) && (row.type === "mirror" || ["thickness_mm", "semi_diameter_mm"].includes(key)),
    /// Text of a cell.
    shown(row, key) {
      const value = key.match(/^a\d+$/) ? (row.aspheric[key.slice(1)] ?? 0) : row[key];
      return value === null ? "" : typeof value === "number" ? this.number(value, 7) : value;
    },
    number: (value, digits) => (value === null || value === undefined ? "-" : String(Number(value.toPrecision(digits)))),
    undoByKey(event) {
      const key = event.key.toLowerCase(), isTyping = /^(input|select|textarea)$/i.test(event.target.tagName);
      if (!(event.ctrlKey || event.metaKey) || !["z", "y"].includes(key) || isTyping) return;
      this.send(key === "y" || event.shiftKey ? "redo" : "undo");
      event.preventDefault();
    },
    send(type, more = {}) {
      this.stream.send({ type, ...more });
    },
    /// Sends a cell of the table that the user has changed.
    edit(surface, field, text) {
      this.typed = { cell: `${surface}-${field}`, text, isSent: true }; // shown until the edited lens arrives
      const isNumber = field !== "glass" && text.trim() !== "" && !Number.isNaN(Number(text));
      this.send("edit", { surface, field, value: isNumber ? Number(text) : text });
    },
    /// Begins to drag a handle.
    startDrag(event, handle) {
      this.$refs.svg.setPointerCapture(event.pointerId);
      // The scale is fixed during a drag; reading it at each step would force a page layout each time.
      this.held = {
        ...handle, surface: this.chosen, from: { ...this.surface }, gesture: ++gestures, scale: this.$refs.svg.getScreenCTM(),
      };
      event.preventDefault();
    },
    /// Position of the mouse in mm.
    positionOf(event) {
      const m = this.held.scale;
      return [(event.clientX - m.e) / m.a, -(event.clientY - m.f) / m.d];
    },
    /// Draws the dragged surface, and sends the new value.
    drag(event) {
      const held = this.held;
      if (!held) return;
      const [z, y] = this.positionOf(event), s = held.from, now = { ...s };
      if (held.field === "semi_diameter_mm") now.semi_diameter_mm = Math.max(0.01 * s.semi_diameter_mm, y);
      else if (held.field === "radius_mm") now.radius_mm = radiusOfSag(s, 0.7 * s.semi_diameter_mm, z - s.z);
      else now.z = z;
      this.dragged = text(profile(now));
      const isMove = held.field === "thickness_mm";
      const before = isMove ? this.view.surfaces[held.surface - 1] : null;
      held.thickness ??= before?.thickness_mm;
      this.sendDrag({
        type: "edit", gesture: held.gesture, field: held.field,
        surface: isMove ? held.surface - 1 : held.surface,
        value: isMove ? held.thickness + z - s.z : now[held.field],
      });
    },
    /// Ends a drag.
    drop() {
      if (!this.held) return;
      this.held = null;
      if (!this.problem) this.dragged = null;
      this.fit();
    },
  },
};

// The bundled lenses as cards, filtered by name, kind and numbers.

// Choices of the filters: ranges from the first number up to the last.
const FOCAL_LENGTHS_MM = [[0, 20], [20, 35], [35, 70], [70, 135], [135, Infinity]];
const F_NUMBERS = [1.4, 2, 2.8, 4];
const TOLERANCE = 1.05; // f-numbers exceed a standard one by up to this ratio and are still engraved as that one
const YEARS = [[0, 1949], [1950, 1969], [1970, 1989], [1990, Infinity]];

/// Text of a range: of integers including the last, or of numbers below its end.
const range = ([from, to], last = "below") =>
  !from ? `${last === "below" ? "below" : "until"} ${to}` : to === Infinity ? `from ${from}` : `${from} to ${to}`;

export default {
  props: { lenses: Array },
  template: `
<button type="button" class="rc-button" @click="open">Gallery</button>
<dialog ref="dialog" class="rc-dialog rc-gallery" aria-labelledby="rc-gallery-title" data-testid="gallery">
  <div class="rc-dialog-head">
    <h2 id="rc-gallery-title">Lenses</h2>
    <input type="search" v-model="words" @keydown.esc.prevent="$refs.dialog.close()" aria-label="Search by name" placeholder="Search by name" data-testid="gallery-search">
    <label v-for="choice in choices" :key="choice.name">{{ choice.label }}
      <select v-model="chosen[choice.name]" :data-testid="'gallery-' + choice.name" :title="choice.help">
        <option :value="null">any</option>
        <option v-for="option in choice.options" :key="option.text" :value="option">{{ option.text }}</option>
      </select></label>
    <span role="status" class="rc-note" data-testid="gallery-count">{{ found.length }} of {{ lenses.length }}</span>
    <button type="button" class="rc-close" aria-label="Close" title="Close (Esc)" @click="$refs.dialog.close()">×</button>
  </div>
  <ul v-if="isOpened">
    <li v-for="lens in found" :key="lens.name">
      <button type="button" :title="lens.title" :aria-label="lens.name" @click="choose(lens)">
        <img :src="'/realcam-lenses/' + lens.name + '.svg'" alt="" loading="lazy" width="190" height="146">
        <b>{{ lens.name }}</b>
        <span>{{ number(lens.focal_length_mm) }} mm f/{{ number(lens.f_number) }}, {{ lens.angle_deg.toFixed(0) }}°</span>
        <span>{{ lens.kind }}{{ lens.year ? ", " + lens.year : "" }}</span>
      </button>
    </li>
  </ul>
  <p v-if="!found.length">No lens matches these filters.</p>
</dialog>`,
  data() {
    const kinds = [...new Set(this.lenses.map((lens) => lens.kind))].sort();
    const choices = [
      { name: "kind", label: "Kind", help: "Kind of lens, by its diagonal angle of view and its purpose",
        options: kinds.map((kind) => ({ text: kind, has: (lens) => lens.kind === kind })) },
      { name: "focal-length", label: "Focal length", help: "Focal length in mm; that of a zoom at its first position",
        options: FOCAL_LENGTHS_MM.map(([from, to]) => ({ text: `${range([from, to])} mm`,
          has: ({ focal_length_mm: mm }) => from <= mm && mm < to })) },
      { name: "f-number", label: "Wide open", help: "The f-number of the lens wide open",
        options: F_NUMBERS.map((most) => ({ text: `f/${most} or faster`, has: (lens) => lens.f_number < TOLERANCE * most })) },
      { name: "year", label: "Year", help: "Year of the patent or book with the prescription",
        options: YEARS.map(([from, to]) => ({ text: range([from, to], "whole"),
          has: ({ year }) => year && from <= year && year <= to })) },
    ];
    return { words: "", choices, chosen: Object.fromEntries(choices.map(({ name }) => [name, null])), isOpened: false };
  },
  computed: {
    found() {
      const words = this.words.toLowerCase().split(/\s+/).filter(Boolean);
      const tests = Object.values(this.chosen).filter(Boolean);
      return this.lenses.filter((lens) => {
        const text = `${lens.name} ${lens.title}`.toLowerCase();
        return words.every((word) => text.includes(word)) && tests.every((test) => test.has(lens));
      });
    },
  },
  methods: {
    number: (value) => String(Number(value.toPrecision(3))),
    open() {
      this.isOpened = true;
      this.$refs.dialog.showModal();
    },
    choose(lens) {
      this.$refs.dialog.close();
      this.$emit("chosen", lens.name);
    },
  },
};

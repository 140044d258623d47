// Dialog of mouse and keyboard controls, opened by its button or the key "?".

const ROWS = [
  ["drag, arrow keys", "move the camera around its subject"],
  ["Shift or right button and drag, Shift and arrow keys", "move the camera sideways"],
  ["wheel, + and -", "move the camera nearer, farther"],
  ["click, F", "focus on the point; F: in the middle of the picture"],
  ["click with Meter, M", "expose so that the spot becomes middle grey; M: in the middle"],
  ["[ and ]", "aperture ring, a third of a stop a step"],
  [", and .", "exposure time"],
  ["I and Shift I", "ISO"],
  ["Z and Shift Z", "zoom ring: longer and shorter focal length"],
  ["Ctrl Z, Ctrl Y", "undo and redo a change of lens, zoom or film"],
  ["drag a dot in the drawing", "rim, radius of curvature or position of the surface that was clicked"],
  ["Tab", "to the next control; the arrow keys turn a ring"],
  ["?", "this table; Esc closes it"],
];

export default {
  template: `
<button type="button" class="rc-button" aria-label="Mouse and keys" title="Mouse and keys (?)" @click="open">?</button>
<dialog ref="dialog" class="rc-dialog rc-help" aria-labelledby="rc-help-title" data-testid="help">
  <div class="rc-dialog-head">
    <h2 id="rc-help-title">Mouse and keys</h2>
    <button type="button" class="rc-close" aria-label="Close" title="Close (Esc)" @click="$refs.dialog.close()">×</button>
  </div>
  <table><tbody><tr v-for="[keys, what] in rows" :key="keys"><th scope="row">{{ keys }}</th><td>{{ what }}</td></tr></tbody></table>
  <p class="rc-note">The camera's keys work while the picture has the focus: click it, or go to it by Tab.</p>
</dialog>`,
  data: () => ({ rows: ROWS }),
  mounted() {
    window.addEventListener("keydown", this.key);
  },
  unmounted() {
    window.removeEventListener("keydown", this.key);
  },
  methods: {
    open() {
      this.$refs.dialog.showModal();
    },
    key(event) {
      const isTyping = event.target.matches?.("input:not([type=range], [type=radio], [type=checkbox]), select, textarea");
      if (event.key !== "?" || isTyping || document.querySelector("dialog[open]")) return;
      this.open();
      event.preventDefault();
    },
  },
};

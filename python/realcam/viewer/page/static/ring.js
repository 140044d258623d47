// A ring or dial of the camera: a slider labelled with the engraving of its position.

export default {
  props: { label: String, help: String, last: Number, step: Number, text: String, answered: Number },
  template: `
<input class="rc-ring" type="range" min="0" :max="last" :value="at" :aria-label="label" :aria-valuetext="text"
  :title="help" @input="turn" @change="gestures += 1">`,
  data() {
    return { turns: this.answered, turned: this.step, gestures: 0 }; // number of changes, last step set by the user, drags
  },
  computed: {
    /// Step to show: the user's own until the server has answered the last change.
    at() {
      return this.answered === this.turns ? this.step : this.turned;
    },
  },
  methods: {
    turn(event) {
      this.turned = Number(event.target.value);
      this.turns += 1;
      this.$emit("turned", { step: this.turned, turn: this.turns, gesture: this.gestures });
    },
  },
};

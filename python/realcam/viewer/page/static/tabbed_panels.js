// Row of tabs and panel of the chosen tab, following the tabs pattern of the ARIA Authoring Practices Guide.

export default {
  props: { names: Array },
  template: `
<div class="rc-tabs">
  <div class="rc-tab-list" role="tablist" aria-label="Panels" @keydown="key">
    <button v-for="name in names" :key="name" type="button" role="tab" :id="'rc-tab-' + name" :aria-selected="name === shown"
      :aria-controls="'rc-panel-' + name" :tabindex="name === shown ? 0 : -1" @click="show(name)">{{ name }}</button>
  </div>
  <slot></slot>
  <div v-for="name in names" :key="name" v-show="name === shown" role="tabpanel" :id="'rc-panel-' + name"
    :aria-labelledby="'rc-tab-' + name"><slot :name="name"></slot></div>
</div>`,
  data() {
    return { shown: this.names[0] };
  },
  methods: {
    show(name) {
      this.shown = name;
      this.$emit("shown", name);
    },
    key(event) {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      const count = this.names.length;
      this.show(this.names[(this.names.indexOf(this.shown) + step + count) % count]);
      this.$nextTick(() => document.getElementById(`rc-tab-${this.shown}`).focus());
      event.preventDefault();
    },
  },
};

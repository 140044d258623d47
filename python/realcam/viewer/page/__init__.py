"""The page of the lens bench: its layout, panels and Vue components, and what the server keeps of each window."""

"""Camera models: projections of directions to a plane, distortions of the plane, and pixels."""

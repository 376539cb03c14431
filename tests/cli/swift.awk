# A model in text with frames: nodes left of x = 0 move with LEFT m/s along x in the last of `frames` frames, others with RIGHT.
/^crc/ { next }
/^array / { reading = $2; i = 0; fast += $2 == "node.velocity"; print; next }
/^(frame|end|axis|meta)/ { reading = "" }
reading == "node.position" { at[i++] = $1 }
reading == "node.velocity" && fast == frames { print at[i++] < 0 ? LEFT : RIGHT, 0, 0; next }
{ print }

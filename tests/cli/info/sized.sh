# Built-in scenes of any size: settings after commas, refused where they are wrong.
alpenglow info builtin:atrium,triangles=30000 | head -2
for scene in atrium,triangles=10 atrium,trees=4 terrain,triangles=many cornell,triangles=30000; do
    alpenglow info builtin:$scene
    echo $?
done

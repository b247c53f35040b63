"""What a robot is: DH tables, URDF files, and the frozen handle both become."""

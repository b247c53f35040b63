"""What an arm is: DH table, URDF both ways, Robot, names and files.

==================  ==============================================================================
module              what it holds
==================  ==============================================================================
``dh``              DH tables: links, conventions, and the hand product of link transforms
``extract``         The way back: any serial robot to a modified DH table, dynamics included
``library``         Names to robots: the shipped tables, example-robot-data, and files
``link``            One row of a DH table: convention, geometry, limits, inertia, and what an
                    inertia can be
``payload``         A load in the tool: the same arm with a heavier last link
``robot``           Robot: a small frozen handle of a serial arm in Pinocchio. It only looks
                    things up
``rotations``       Rotations: about an axis, along a rotation vector, and as URDF writes them
``strict_numbers``  The one reader of plain numbers in files: what it accepts, every other program
                    reads alike
``table_files``     DH tables as files: TOML (read and written) and CSV (read), as plain values
``urdf_engine``     From records to the engine, and back again to see that nothing changed on the
                    way
``urdf_read``       Reading a URDF: refuses what Pinocchio would accept without a word, and builds
                    its model
``urdf_records``    A URDF as plain records: every number read strictly, every default written out
``urdf_write``      DH table to URDF: where its joints and links stand, what the arm looks like,
                    and the text
==================  ==============================================================================
"""
